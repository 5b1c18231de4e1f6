// The part of a frame that shows the taught back from somewhere else: its grey levels, made of the template's
// picture and of the back's shape.
//
// Convention: X_cur = R_cur_from_ref X_ref + t. Units: pixels of the frame (distorted), t/d, grey levels.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "heel/camera_model.h"
#include "heel/shirt_template.h"
#include "vision/patches/grey_pyramid.h"
#include "vision/pose/back_surface.h"
#include "vision/pose/frontal_pose_estimator.h"

namespace heel {

/// Folds that the cloth did not have when it was taught: a sum of waves along the normal.
struct ClothFolds {
  struct Wave {
    Eigen::Vector2d per_ray = Eigen::Vector2d::Zero();  ///< phase, radians for each unit of (x, y)
    double phase_rad = 0.0;
    double height = 0.0;  ///< in units of d
  };
  std::array<Wave, 4> waves;

  double at(const Eigen::Vector3d& ray) const;
};

class BackPicture {
 public:
  /// `shirt` and `surface` must outlive this.
  BackPicture(const ShirtTemplate& shirt, const BackSurface& surface, const CameraModel& camera);

  /// Draws the back over `frame` (row-major, of the camera's size). A pixel is the mean of what it covers.
  void draw(const FrontalMotion& motion, const ClothFolds& folds, std::vector<float>& frame);

 private:
  struct Vertex {
    Eigen::Vector2d px = Eigen::Vector2d::Zero();
    Eigen::Vector2d ref_px = Eigen::Vector2d::Zero();  ///< distorted, in the template's picture
    double depth = 0.0;
  };
  /// Samples of the part of the frame that the back covers, several to a pixel.
  struct Samples {
    int left_px = 0, top_px = 0, width_px = 0, height_px = 0;
    int per_pixel = 1;  ///< in a row
    std::vector<float> grey;
    std::vector<float> depth;  ///< infinite: nothing there
  };

  void project(const FrontalMotion& motion, const ClothFolds& folds);
  void frame_samples(const FrontalMotion& motion);
  void draw_triangle(const Vertex& a, const Vertex& b, const Vertex& c);
  void blend(std::vector<float>& frame) const;

  const BackSurface& surface_;
  CameraModel reference_camera_, camera_;
  GreyPyramid reference_;
  std::vector<Vertex> vertices_;  // row by row
  Samples samples_;
};

}  // namespace heel
