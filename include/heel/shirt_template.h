/// \file
/// The template: the reference view of the shirt with its region, its distance and its camera; and a verdict
/// on how well a person can be followed by it.
///
/// - Convention: the reference view is fronto-parallel to the back at distance d: plane z = d, normal
///   (0,0,1) in the reference camera's frame.
/// - Units: pixels, metres.
/// - Errors: judge_template() gives a reason, it does not throw. Both functions expect an image of
///   camera.width_px × camera.height_px.
/// - Source: M. Burke, W. Brink, "Estimating Target Orientation with a Single Camera for Use in a
///   Human-Following Robot", PRASA 2010.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "heel/camera_model.h"
#include "heel/features.h"

namespace heel {

/// Another picture of the same back, by the same camera, and where the template was found in it:
/// X_further / d = R_further_from_ref X_ref / d + t_over_d.
struct FurtherView {
  std::vector<std::uint8_t> grey;  ///< as ShirtTemplate::grey
  Eigen::Matrix3d R_further_from_ref = Eigen::Matrix3d::Identity();
  Eigen::Vector3d t_over_d = Eigen::Vector3d::Zero();
};

/// What a .heel file holds. Features are not stored but computed from the image, so that they always come
/// from the same code as the frame's.
struct ShirtTemplate {
  std::vector<std::uint8_t> grey;  ///< whole image, row-major, camera.width_px × camera.height_px
  CameraModel camera;
  Region roi;               ///< the back of the shirt
  double distance_m = 0.0;  ///< camera to the back along z; 0: not known
  double yaw_rad = 0.0;     ///< how far the person was turned: 0 from behind, ±π/2 a side, π the front
  bool oriented = false;    ///< use oriented descriptors (default upright)
  int max_features = 300;   ///< template features kept
  bool upright = false;     ///< its pictures are said to be: turned before it was taught, or without need
  bool is_first = false;    ///< among several: stands for the first one, for itself and those behind it
  std::vector<FurtherView> further_views;  ///< turned or farther away: they help to find the back there
};

/// The features of the template's region (sigma over a wide range), strongest first.
FeatureSet template_features(const ShirtTemplate& shirt);

/// How well a template can be followed, and why.
struct TemplateVerdict {
  bool usable = false;
  std::string reason;  ///< one line when not usable
  int features = 0;
  double spread = 0.0;           ///< 0…1: share of a 4 × 4 grid over the region that holds a feature
  double self_similarity = 0.0;  ///< 0…1: share of features with a nearly equal one elsewhere on the shirt
  double coarse_share = 0.0;     ///< 0…1: share of features recognised from twice the distance
};
/// Searches and matches the view itself, at half its size, as a frame would be.
TemplateVerdict judge_template(const ShirtTemplate& shirt);

}  // namespace heel
