#include "sim/scene/renderer.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/random.h"
#include "sim/render/jpeg_round_trip.h"
#include "sim/scene/world.h"

namespace heel::sim {
namespace {

constexpr int kRoomBody = 0;
constexpr int kFirstPersonBody = 1;
constexpr float kBackgroundGrey =
    120.f;  ///< where there is no surface, which is only possible outside the room

int body_of(std::size_t person, int part) {
  return kFirstPersonBody + static_cast<int>(person) * kPersonParts + part;
}

}  // namespace

Renderer::Renderer(const World& world, int threads)
    : world_(world),
      workers_(threads),
      rays_(world.scenario().camera.model),
      rasteriser_(rays_, workers_),
      sensor_(rays_, world.scenario().camera.sensor, derived_seed(world.scenario().seed, 0x5e), workers_) {
  motion_.blocks_x = (rays_.camera.width_px + kMotionBlock_px - 1) / kMotionBlock_px;
  motion_.blocks_y = (rays_.camera.height_px + kMotionBlock_px - 1) / kMotionBlock_px;
  motion_.dx_px.resize(static_cast<std::size_t>(motion_.blocks_x) * motion_.blocks_y);
  motion_.dy_px.resize(motion_.dx_px.size());
}

Renderer::Moment Renderer::moment(const RobotMotion& robot, double t_s, double offset_s) const {
  Moment out{world_.world_from_camera(moved(robot, offset_s)).inverse(), {}};
  for (std::size_t i = 0; i < world_.people().size(); ++i)
    out.people.push_back(world_.pose_of(i, t_s + offset_s));
  return out;
}

void Renderer::draw(const RobotMotion& robot, double t_s, std::uint64_t frame,
                    std::vector<std::uint8_t>& grey) {
  const Exposure exposure = world_.exposure(t_s);
  const double half_open_s = 0.5e-3 * exposure.exposure_ms;
  const double half_readout_s = 0.5e-3 * world_.scenario().camera.readout_ms;
  Moments moments;
  moments.now = moment(robot, t_s, 0.0);
  moments.opens = moment(robot, t_s, -half_open_s);
  moments.closes = moment(robot, t_s, half_open_s);
  const bool rolls = half_readout_s > 0.0;
  moments.first_row = rolls ? moment(robot, t_s, -half_readout_s) : moments.now;
  moments.last_row = rolls ? moment(robot, t_s, half_readout_s) : moments.now;
  draw(moments, exposure, frame, grey);
}

void Renderer::draw_still(const PersonPose& target, const Eigen::Isometry3d& view_from_world,
                          std::uint64_t frame, std::vector<std::uint8_t>& grey) {
  const Moment still{view_from_world, {target}};
  Exposure exposure;
  exposure.exposure_ms = world_.scenario().camera.sensor.exposure_ms;
  draw({still, still, still, still, still}, exposure, frame, grey);
}

void Renderer::draw(const Moments& moments, const Exposure& exposure, std::uint64_t frame,
                    std::vector<std::uint8_t>& grey) {
  rasteriser_.clear();
  // The nearest things first: the depth test then rejects most of what is behind them.
  for (std::size_t i = 0; i < moments.now.people.size(); ++i) add_person(moments, i);
  add_room(moments);
  rasteriser_.draw(kBackgroundGrey, radiance_);
  measure_motion(moments);
  sensor_.expose(radiance_, motion_, exposure, frame, grey);
  if (const int quality = world_.scenario().camera.jpeg_quality; quality > 0)
    jpeg_round_trip(grey, rays_.camera.width_px, rays_.camera.height_px, quality);
}

void Renderer::add_room(const Moments& moments) {
  const Eigen::Isometry3f now = moments.now.camera_from_world.cast<float>();
  const Eigen::Matrix4f shift =
      (moments.last_row.camera_from_world.matrix() - moments.first_row.camera_from_world.matrix())
          .cast<float>();
  const bool rolls = !shift.isZero(0.f);
  std::array<Corner, 3> corners;
  for (const StaticFace& face : world_.room().faces()) {
    for (std::size_t i = 0; i < 3; ++i) {
      corners[i] = {now * face.corners_m[i], face.s_texel[i], face.t_texel[i], face.light[i]};
      if (rolls) corners[i].shift_m = (shift * face.corners_m[i].homogeneous()).head<3>();
    }
    rasteriser_.add(face.shape, corners, {face.texture, face.texels_per_m, kRoomBody});
  }
}

/// Whether a ball around the person reaches into the pyramid of the picture's rays.
bool Renderer::may_be_visible(const PersonPose& person, const Eigen::Isometry3d& camera_from_world) const {
  constexpr double kReach_m = 1.2;  // a little more than from the hips to the farthest part
  const Eigen::Vector3d hips = camera_from_world * person.world_from_part[kTorso].translation();
  const double x_max = static_cast<double>(rays_.x_max);
  return hips.z() > -kReach_m && std::abs(hips.x()) < x_max * hips.z() + kReach_m * std::hypot(1.0, x_max);
}

void Renderer::add_person(const Moments& moments, std::size_t index) {
  const PersonPose& pose = moments.now.people[index];
  if (!may_be_visible(pose, moments.now.camera_from_world)) return;
  const Person& person = world_.people()[index].person;
  add_part(person.torso().mesh(pose.cloth), kTorso, moments, index);
  for (int part = kTorso + 1; part < kPersonParts; ++part)
    add_part(person.mesh(static_cast<PersonPart>(part)), static_cast<PersonPart>(part), moments, index);
}

void Renderer::add_part(const Mesh& mesh, PersonPart part, const Moments& moments, std::size_t index) {
  const auto camera_from_part = [&](const Moment& moment) -> Eigen::Isometry3d {
    return moment.camera_from_world * moment.people[index].world_from_part[part];
  };
  const Eigen::Isometry3f to_world = moments.now.people[index].world_from_part[part].cast<float>();
  const Eigen::Isometry3f to_camera = camera_from_part(moments.now).cast<float>();
  const Eigen::Matrix4f shift =
      (camera_from_part(moments.last_row).matrix() - camera_from_part(moments.first_row).matrix())
          .cast<float>();
  const bool rolls = !shift.isZero(0.f);
  corners_.clear();
  for (const MeshVertex& vertex : mesh.vertices) {
    corners_.push_back({to_camera * vertex.position_m, vertex.s_texel, vertex.t_texel,
                        world_.light().at(to_world * vertex.position_m, to_world.linear() * vertex.normal)});
    if (rolls) corners_.back().shift_m = (shift * vertex.position_m.homogeneous()).head<3>();
  }
  rasteriser_.add_mesh(corners_, mesh.triangles, {mesh.texture, mesh.texels_per_m, body_of(index, part)});
}

/// For each body, the camera frames when the shutter opens and closes, from the camera frame in the middle.
std::vector<Renderer::ShutterMotion> Renderer::body_motions(const Moments& moments) {
  std::vector<ShutterMotion> motions;
  const Eigen::Isometry3d world_from_camera = moments.now.camera_from_world.inverse();
  const auto add = [&](const Eigen::Isometry3d& to_opening, const Eigen::Isometry3d& to_closing) {
    motions.push_back({to_opening.cast<float>(), to_closing.cast<float>()});
  };
  add(moments.opens.camera_from_world * world_from_camera,
      moments.closes.camera_from_world * world_from_camera);
  for (std::size_t i = 0; i < moments.now.people.size(); ++i)
    for (std::size_t part = 0; part < kPersonParts; ++part) {
      const Eigen::Isometry3d part_from_camera =
          moments.now.people[i].world_from_part[part].inverse() * world_from_camera;
      add(moments.opens.camera_from_world * moments.opens.people[i].world_from_part[part] * part_from_camera,
          moments.closes.camera_from_world * moments.closes.people[i].world_from_part[part] *
              part_from_camera);
    }
  return motions;
}

/// Image motion of each block: that of the surface point in its middle, which moves with its body.
void Renderer::measure_motion(const Moments& moments) {
  const std::vector<ShutterMotion> motions = body_motions(moments);
  const auto fx = static_cast<float>(rays_.camera.fx);
  const auto fy = static_cast<float>(rays_.camera.fy);
  for (int by = 0; by < motion_.blocks_y; ++by) {
    for (int bx = 0; bx < motion_.blocks_x; ++bx) {
      const int x = std::min(bx * kMotionBlock_px + kMotionBlock_px / 2, rays_.camera.width_px - 1);
      const int y = std::min(by * kMotionBlock_px + kMotionBlock_px / 2, rays_.camera.height_px - 1);
      const auto block = static_cast<std::size_t>(by) * motion_.blocks_x + bx;
      const float inverse_depth = rasteriser_.inverse_depth(x, y);
      motion_.dx_px[block] = 0.f;
      motion_.dy_px[block] = 0.f;
      if (inverse_depth <= 0.f) continue;
      const auto pixel = static_cast<std::size_t>(y) * rays_.camera.width_px + x;
      const float z = 1.f / inverse_depth;
      const Eigen::Vector3f point(rays_.x[pixel] * z, rays_.y[pixel] * z, z);
      const auto& [to_opening, to_closing] = motions[static_cast<std::size_t>(rasteriser_.body(x, y))];
      const Eigen::Vector3f a = to_opening * point;
      const Eigen::Vector3f b = to_closing * point;
      if (a.z() < 0.05f || b.z() < 0.05f) continue;
      motion_.dx_px[block] = fx * (b.x() / b.z() - a.x() / a.z());
      motion_.dy_px[block] = fy * (b.y() / b.z() - a.y() / a.z());
    }
  }
}

}  // namespace heel::sim
