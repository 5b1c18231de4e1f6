// Drawing order: room, person (depth buffer), shading, motion of every block, sensor.
#include "heel-sim/world/world.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "heel-sim/world/random.h"
#include "heel/error.h"

namespace heel::sim {
namespace {

constexpr int kRoomBody = 0;
constexpr int kFirstPersonBody = 1;
constexpr float kNothingGrey = 120.f;  ///< where no surface is: only possible outside the room

FloorPlan plan_of(const Scenario& scenario, const Walk& walk) {
  FloorPlan plan;
  plan.walked_m.emplace_back(scenario.robot.x_m, scenario.robot.y_m);
  // Every tenth sample: some centimetres apart.
  for (std::size_t i = 0; i < walk.samples().size(); i += 10)
    plan.walked_m.emplace_back(walk.samples()[i].x_m, walk.samples()[i].y_m);
  return plan;
}

/// Columns are the camera's axes in the robot frame: x right, y down, z forwards, then pitched up.
Eigen::Matrix3d robot_from_level_camera() {
  Eigen::Matrix3d R;
  R << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return R;
}

RobotMotion moved(const RobotMotion& robot, double dt_s) {
  RobotMotion out = robot;
  const double mid_heading = robot.heading_rad + 0.5 * dt_s * robot.yaw_rate_rad_s;
  out.x_m += dt_s * robot.v_m_s * std::cos(mid_heading);
  out.y_m += dt_s * robot.v_m_s * std::sin(mid_heading);
  out.heading_rad += dt_s * robot.yaw_rate_rad_s;
  return out;
}

}  // namespace

World::World(const Scenario& scenario)
    : scenario_(scenario),
      walk_(scenario.person_start, scenario.path),
      light_(scenario.light, scenario.seed),
      person_(scenario.person, derived_seed(scenario.seed, 0x50)),
      room_(scenario.room, plan_of(scenario, walk_), light_, derived_seed(scenario.seed, 0x20)),
      rays_(scenario.camera.model),
      rasteriser_(rays_),
      sensor_(rays_, scenario.camera.sensor, derived_seed(scenario.seed, 0x5e)) {
  motion_.blocks_x = (scenario.camera.model.width_px + kMotionBlockPx - 1) / kMotionBlockPx;
  motion_.blocks_y = (scenario.camera.model.height_px + kMotionBlockPx - 1) / kMotionBlockPx;
  motion_.dx_px.resize(static_cast<std::size_t>(motion_.blocks_x) * motion_.blocks_y);
  motion_.dy_px.resize(motion_.dx_px.size());
}

Eigen::Isometry3d World::world_from_camera(const RobotMotion& robot) const {
  const ScenarioCamera& camera = scenario_.camera;
  Eigen::Isometry3d robot_from_camera = Eigen::Isometry3d::Identity();
  robot_from_camera.translation() << camera.mount_x_m, camera.mount_y_m, camera.mount_z_m;
  // The camera's x axis points right: a positive turn about it lifts the view.
  robot_from_camera.linear() =
      robot_from_level_camera() *
      Eigen::AngleAxisd(camera.mount_pitch_rad, Eigen::Vector3d::UnitX()).toRotationMatrix();
  return Eigen::Translation3d(robot.x_m, robot.y_m, 0.0) *
         Eigen::AngleAxisd(robot.heading_rad, Eigen::Vector3d::UnitZ()) * robot_from_camera;
}

PersonPose World::person_pose(double t_s) const {
  return person_.pose(walk_.at(t_s - walk_start_s_), t_s);
}

Eigen::Vector2d World::project_px(const Eigen::Vector3d& point_in_camera_m) const {
  const CameraModel& camera = scenario_.camera.model;
  const Eigen::Vector2d ideal(camera.fx * point_in_camera_m.x() / point_in_camera_m.z() + camera.cx,
                              camera.fy * point_in_camera_m.y() / point_in_camera_m.z() + camera.cy);
  return camera.distort_px(ideal);
}

Truth World::truth(const RobotMotion& robot, double t_s) const {
  const PersonPose person = person_pose(t_s);
  const Eigen::Isometry3d& world_from_torso = person.world_from_part[kTorso];
  Truth truth;
  truth.person = person.walk;
  const Eigen::Vector3d forwards = world_from_torso.linear().col(0);
  truth.back_yaw_rad = person.walk.heading_rad +
                       std::remainder(std::atan2(forwards.y(), forwards.x()) - person.walk.heading_rad,
                                      2.0 * std::numbers::pi);
  truth.back_m = world_from_torso * person_.back_centre_m();
  truth.world_from_camera = world_from_camera(robot);
  const Eigen::Isometry3d camera_from_world = truth.world_from_camera.inverse();
  truth.back_in_camera_m = camera_from_world * truth.back_m;
  const Eigen::Vector3d direction = camera_from_world.linear() * forwards;
  truth.yaw_rad = std::atan2(direction.x(), direction.z());
  const bool in_front = truth.back_in_camera_m.z() > 0.1;
  const RayTable& rays = rays_;
  if (in_front && std::abs(truth.back_in_camera_m.x()) <= rays.x_max * 1.2 * truth.back_in_camera_m.z() &&
      std::abs(truth.back_in_camera_m.y()) <= rays.y_max * 1.2 * truth.back_in_camera_m.z()) {
    truth.back_px = project_px(truth.back_in_camera_m);
    const CameraModel& camera = scenario_.camera.model;
    truth.in_view = truth.back_px.x() >= 0 && truth.back_px.y() >= 0 &&
                    truth.back_px.x() <= camera.width_px - 1 && truth.back_px.y() <= camera.height_px - 1 &&
                    direction.dot(truth.back_in_camera_m) > 0.0;
  }
  return truth;
}

World::Moment World::moment(const RobotMotion& robot, double t_s, double offset_s) const {
  return {world_from_camera(moved(robot, offset_s)).inverse(), person_pose(t_s + offset_s)};
}

void World::render(const RobotMotion& robot, double t_s, std::uint64_t frame,
                   std::vector<std::uint8_t>& grey) {
  const double half_s = 0.5e-3 * scenario_.camera.sensor.exposure_ms;
  render(moment(robot, t_s, -half_s), moment(robot, t_s, 0.0), moment(robot, t_s, half_s), frame, grey);
}

void World::render(const Moment& before, const Moment& now, const Moment& after, std::uint64_t frame,
                   std::vector<std::uint8_t>& grey) {
  rasteriser_.clear();
  draw_person(now);
  draw_room(now.camera_from_world);
  rasteriser_.shade(kNothingGrey, radiance_);
  measure_motion(before, now, after);
  sensor_.expose(radiance_, motion_, frame, grey);
}

void World::draw_room(const Eigen::Isometry3d& camera_from_world) {
  const Eigen::Isometry3f transform = camera_from_world.cast<float>();
  Face out;
  out.body = kRoomBody;
  for (const StaticFace& face : room_.faces()) {
    out.shape = face.shape;
    for (std::size_t i = 0; i < 3; ++i)
      out.corners[i] = {transform * face.corners_m[i], face.s_texel[i], face.t_texel[i], face.light[i]};
    out.texture = face.texture;
    out.texels_per_m = face.texels_per_m;
    rasteriser_.draw(out);
  }
}

void World::draw_person(const Moment& now) {
  const Mesh torso = person_.torso_mesh(now.person);
  for (int part = 0; part < kPersonParts; ++part) {
    const Mesh& mesh = part == kTorso ? torso : person_.mesh(static_cast<PersonPart>(part));
    draw_mesh(mesh, now.person.world_from_part[static_cast<std::size_t>(part)], now.camera_from_world,
              kFirstPersonBody + part);
  }
}

void World::draw_mesh(const Mesh& mesh, const Eigen::Isometry3d& world_from_body,
                      const Eigen::Isometry3d& camera_from_world, int body) {
  const Eigen::Isometry3f to_world = world_from_body.cast<float>();
  const Eigen::Isometry3f to_camera = (camera_from_world * world_from_body).cast<float>();
  std::vector<Corner> corners;
  corners.reserve(mesh.vertices.size());
  for (const MeshVertex& vertex : mesh.vertices)
    corners.push_back({to_camera * vertex.position_m, vertex.s_texel, vertex.t_texel,
                       light_.at(to_world * vertex.position_m, to_world.linear() * vertex.normal)});
  Face face;
  face.shape = FaceShape::Triangle;
  face.texture = mesh.texture;
  face.texels_per_m = mesh.texels_per_m;
  face.body = body;
  for (const auto& triangle : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) face.corners[i] = corners[static_cast<std::size_t>(triangle[i])];
    rasteriser_.draw(face);
  }
}

/// Image motion of what each block shows: the surface point at its middle, carried along with its body.
void World::measure_motion(const Moment& before, const Moment& now, const Moment& after) {
  // before/after the exposure, from the camera frame in its middle
  std::array<std::pair<Eigen::Isometry3d, Eigen::Isometry3d>, kFirstPersonBody + kPersonParts> carried;
  const Eigen::Isometry3d world_from_camera = now.camera_from_world.inverse();
  carried[kRoomBody] = {before.camera_from_world * world_from_camera,
                        after.camera_from_world * world_from_camera};
  for (std::size_t part = 0; part < kPersonParts; ++part) {
    const Eigen::Isometry3d part_from_camera = now.person.world_from_part[part].inverse() * world_from_camera;
    carried[kFirstPersonBody + part] = {
        before.camera_from_world * before.person.world_from_part[part] * part_from_camera,
        after.camera_from_world * after.person.world_from_part[part] * part_from_camera};
  }
  const CameraModel& camera = scenario_.camera.model;
  for (int by = 0; by < motion_.blocks_y; ++by) {
    for (int bx = 0; bx < motion_.blocks_x; ++bx) {
      const int x = std::min(bx * kMotionBlockPx + kMotionBlockPx / 2, camera.width_px - 1);
      const int y = std::min(by * kMotionBlockPx + kMotionBlockPx / 2, camera.height_px - 1);
      const auto block = static_cast<std::size_t>(by) * motion_.blocks_x + bx;
      const float inverse_depth = rasteriser_.inverse_depth(x, y);
      motion_.dx_px[block] = 0.f;
      motion_.dy_px[block] = 0.f;
      if (inverse_depth <= 0.f) continue;
      const auto pixel = static_cast<std::size_t>(y) * camera.width_px + x;
      const double z = 1.0 / static_cast<double>(inverse_depth);
      const Eigen::Vector3d point(rays_.x[pixel] * z, rays_.y[pixel] * z, z);
      const auto& [to_before, to_after] = carried[static_cast<std::size_t>(rasteriser_.body(x, y))];
      const Eigen::Vector3d a = to_before * point;
      const Eigen::Vector3d b = to_after * point;
      if (a.z() < 0.05 || b.z() < 0.05) continue;
      motion_.dx_px[block] = static_cast<float>(camera.fx * (b.x() / b.z() - a.x() / a.z()));
      motion_.dy_px[block] = static_cast<float>(camera.fy * (b.y() / b.z() - a.y() / a.z()));
    }
  }
}

ReferenceView World::reference_view(double distance_m) {
  Moment still;
  still.person = person_.pose(scenario_.person_start, 0.0);
  const Eigen::Isometry3d& world_from_torso = still.person.world_from_part[kTorso];
  const Eigen::Vector3d back = world_from_torso * person_.back_centre_m();
  const double heading = scenario_.person_start.heading_rad;
  const Eigen::Vector3d forwards(std::cos(heading), std::sin(heading), 0.0);
  Eigen::Isometry3d camera = Eigen::Isometry3d::Identity();
  camera.linear() = Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ()) * robot_from_level_camera();
  camera.translation() = back - distance_m * forwards;
  camera.translation().z() = scenario_.camera.mount_z_m;
  still.camera_from_world = camera.inverse();

  // The region: the back between the shoulder blades' outer edges, from below the collar to the waist.
  Eigen::Vector2d low(1e9, 1e9);
  Eigen::Vector2d high(-1e9, -1e9);
  for (const double s : {-160.0, 0.0, 160.0})
    for (const double t : {110.0, 340.0, 600.0}) {
      const Eigen::Vector3d point = person_.shirt_point_m(0.5 * kShirtWidthTexels + s, t);
      const Eigen::Vector2d px = project_px(still.camera_from_world * world_from_torso * point);
      low = low.cwiseMin(px);
      high = high.cwiseMax(px);
    }
  const CameraModel& model = scenario_.camera.model;
  if (distance_m < 0.3 || low.x() < 0 || low.y() < 0 || high.x() > model.width_px - 1 ||
      high.y() > model.height_px - 1)
    throw Error("reference view at " + std::to_string(distance_m) +
                " m: the back does not fit into the picture (expected a larger distance)");
  ReferenceView view;
  view.roi.x_px = static_cast<int>(std::ceil(low.x()));
  view.roi.y_px = static_cast<int>(std::ceil(low.y()));
  view.roi.width_px = static_cast<int>(std::floor(high.x())) - view.roi.x_px + 1;
  view.roi.height_px = static_cast<int>(std::floor(high.y())) - view.roi.y_px + 1;
  view.distance_m = distance_m;
  // A frame number no run reaches: the noise of the reference is not that of a frame.
  render(still, still, still, std::numeric_limits<std::uint32_t>::max(), view.grey);
  return view;
}

}  // namespace heel::sim
