// Draws the pictures of a world, in this order: people and room (depth buffer), shading, motion of every
// block, sensor, compression.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "sim/render/rasteriser.h"
#include "sim/render/ray_table.h"
#include "sim/render/sensor.h"
#include "sim/render/thread_pool.h"
#include "sim/scene/person.h"

namespace heel::sim {

class World;
struct RobotMotion;

class Renderer {
 public:
  /// `world` must outlive it; `threads` as for World.
  Renderer(const World& world, int threads);

  void draw(const RobotMotion& robot, double t_s, std::uint64_t frame, std::vector<std::uint8_t>& grey);
  /// The target alone in the room, without any motion, with a global shutter and in full light.
  void draw_still(const PersonPose& target, const Eigen::Isometry3d& view_from_world, std::uint64_t frame,
                  std::vector<std::uint8_t>& grey);

  const RayTable& rays() const { return rays_; }

 private:
  /// Camera and people at one moment.
  struct Moment {
    Eigen::Isometry3d camera_from_world;
    std::vector<PersonPose> people;
  };
  /// The moments of one frame. `opens` and `closes` are those of the middle row's exposure; `first_row` and
  /// `last_row` the middles of those rows' exposures, with a global shutter the same as `now`.
  struct Moments {
    Moment now;
    Moment opens, closes;
    Moment first_row, last_row;
  };

  /// From the camera frame in the middle of the exposure to those at its ends, for points of one body.
  struct ShutterMotion {
    Eigen::Isometry3f to_opening, to_closing;
  };

  Moment moment(const RobotMotion& robot, double t_s, double offset_s) const;
  void draw(const Moments& moments, const Exposure& exposure, std::uint64_t frame,
            std::vector<std::uint8_t>& grey);
  void add_room(const Moments& moments);
  void add_person(const Moments& moments, std::size_t index);
  void add_part(const Mesh& mesh, PersonPart part, const Moments& moments, std::size_t index);
  bool may_be_visible(const PersonPose& person, const Eigen::Isometry3d& camera_from_world) const;
  static std::vector<ShutterMotion> body_motions(const Moments& moments);
  void measure_motion(const Moments& moments);

  const World& world_;
  ThreadPool workers_;
  RayTable rays_;
  Rasteriser rasteriser_;
  Sensor sensor_;
  std::vector<float> radiance_;
  std::vector<Corner> corners_;  ///< of the mesh being added
  MotionField motion_;
};

}  // namespace heel::sim
