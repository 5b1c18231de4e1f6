#include "evaluation/experiments/back_set.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/angles.h"
#include "core/random.h"
#include "evaluation/experiments/back_set_truth.h"
#include "files/camera_info.h"
#include "files/folder.h"
#include "files/image_file.h"
#include "sim/scene/shirts.h"

namespace heel::evaluation {
namespace {

constexpr double kCameraHeight_m = 1.05;
// The walk: a bend to the right, then one to the left, at an ordinary walking speed.
constexpr double kWalkSpeed_m_s = 1.1;
constexpr double kWalkBend_m = 2.4;
constexpr double kWalkRate_hz = 15.0;
constexpr int kWalkPictures = 78;
constexpr double kWalkStart_s = 3.0;  ///< when the person has reached the speed
constexpr double kWalkDistance_m = 2.0;

sim::Scenario scenario_of(const BackPicture& picture, std::uint64_t seed) {
  sim::Scenario scenario;
  scenario.name = "back_set";
  CameraModel& model = scenario.camera.model;
  model = {};
  model.width_px = 640;
  model.height_px = 480;
  model.fx = model.fy = 554.0;
  model.cx = 319.5;
  model.cy = 239.5;
  scenario.camera.mount_z_m = kCameraHeight_m;
  scenario.camera.jpeg_quality = 88;
  scenario.camera.sensor.blur_sigma_px = 0.65;
  scenario.camera.sensor.vignetting = 0.0;
  scenario.camera.sensor.gain = 0.8;  // white cloth in the light is not white in the picture
  scenario.light.unevenness = 0.15;
  scenario.room.clearance_m = 4.6;
  scenario.room.margin_m = 8.0;
  scenario.person.shirt = sim::shirt_design(picture.print);
  if (picture.room == "sun") {
    scenario.light.window_share = 1.1;
    scenario.light.window_azimuth_rad = 2.2;
  }
  if (picture.build == kBoardBuild) scenario.person.torso = sim::TorsoShape::Board;
  const std::vector<BackBuild>& builds = back_set_builds();
  const auto build = std::find_if(builds.begin(), builds.end(),
                                  [&](const BackBuild& known) { return known.name == picture.build; });
  if (build != builds.end()) scenario.person.depth = build->depth;
  // Each build is another person, in another shirt and rooms.
  scenario.seed = derived_seed(seed, 1 + static_cast<std::uint64_t>(build - builds.begin()));
  return scenario;
}

/// A level view whose axis points along `heading_rad`, with the point `at_m` at the horizontal distance and
/// bearing.
Eigen::Isometry3d view_of(const Eigen::Vector3d& at_m, double heading_rad, double distance_m,
                          double bearing_rad) {
  const double to_right = bearing_rad;
  const double c = std::cos(heading_rad), s = std::sin(heading_rad);
  const Eigen::Vector3d ahead(c, s, 0), right(s, -c, 0);
  Eigen::Isometry3d world_from_view = Eigen::Isometry3d::Identity();
  world_from_view.linear() << right, Eigen::Vector3d(0, 0, -1), ahead;
  world_from_view.translation() =
      at_m - distance_m * (std::cos(to_right) * ahead + std::sin(to_right) * right);
  world_from_view.translation().z() = kCameraHeight_m;
  return world_from_view.inverse();
}

class BackSet {
 public:
  BackSet(const std::string& folder, std::uint64_t seed, const std::function<void(std::size_t)>& on_progress)
      : folder_(folder), seed_(seed), on_progress_(on_progress) {
    make_folder(folder + "/images");
  }

  void add_stills() {
    std::unique_ptr<sim::World> world;
    TaughtBack taught;
    for (const BackPicture& picture : back_set_stills(seed_)) {
      const BackPicture* last = rows_.empty() ? nullptr : &rows_.back().picture;
      if (!last || last->build != picture.build || last->print != picture.print || last->room != picture.room)
        world = std::make_unique<sim::World>(scenario_of(picture, seed_));
      if (!last || last->build != picture.build || last->print != picture.print) taught = teach(*world);
      sim::WalkState standing;
      standing.heading_rad = picture.heading_rad;
      const sim::PersonPose pose = world->person().pose(standing, 0.0, picture.posture);
      const Eigen::Vector3d at_m =
          pose.world_from_part[sim::kTorso] * world->person().torso().back_centre_m();
      const Eigen::Isometry3d view = view_of(at_m, picture.heading_rad + kRadPerDeg * picture.yaw_deg,
                                             picture.distance_m, kRadPerDeg * picture.bearing_deg);
      add(*world, picture, pose, view, taught);
    }
  }

  void add_walk() {
    BackPicture picture;
    picture.kind = "walk";
    picture.build = back_set_builds().front().name;
    picture.print = "shapes";
    picture.room = "lamps";
    sim::Scenario scenario = scenario_of(picture, seed_);
    using sim::WalkStep;
    scenario.path = {
        {.step = WalkStep::Straight, .speed_m_s = kWalkSpeed_m_s, .length_m = 3.2},
        {.step = WalkStep::Arc, .speed_m_s = kWalkSpeed_m_s, .radius_m = kWalkBend_m, .angle_rad = -0.6},
        {.step = WalkStep::Arc, .speed_m_s = kWalkSpeed_m_s, .radius_m = kWalkBend_m, .angle_rad = 1.2},
        {.step = WalkStep::Straight, .speed_m_s = kWalkSpeed_m_s, .length_m = 4.0}};
    sim::World world(scenario);
    const TaughtBack taught = teach(world);
    world.start_walk(0.0);
    for (int i = 0; i < kWalkPictures; ++i) {
      picture.image = fmt::format("w_{:04}.png", i);
      picture.pose = fmt::format("w{:04}", i);
      picture.t_s = i / kWalkRate_hz;
      const sim::PersonPose pose = world.person_pose(kWalkStart_s + picture.t_s);
      const Eigen::Vector3d at_m(pose.walk.x_m, pose.walk.y_m, 0.0);
      // The camera keeps its direction and follows the person, who comes to the right and to the left.
      picture.bearing_deg = 5.0 * std::sin(1.2 * picture.t_s);
      picture.distance_m = kWalkDistance_m;
      picture.yaw_deg = -pose.walk.heading_rad / kRadPerDeg;
      add(world, picture, pose, view_of(at_m, 0.0, kWalkDistance_m, kRadPerDeg * picture.bearing_deg),
          taught);
    }
  }

  std::size_t write_truth() const {
    write_back_truth(rows_, kCameraHeight_m, folder_ + "/truth.csv");
    write_camera_model(scenario_of(rows_.front().picture, seed_).camera.model, folder_ + "/camera.yaml");
    return rows_.size();
  }

 private:
  static TaughtBack teach(sim::World& world) {
    return taught_back(world, world.taught_pose(), world.reference_view_from_world(kBackSetTeach_m),
                       world.reference_view(kBackSetTeach_m).roi);
  }

  void add(sim::World& world, const BackPicture& picture, const sim::PersonPose& pose,
           const Eigen::Isometry3d& view, const TaughtBack& taught) {
    const CameraModel& camera = world.scenario().camera.model;
    world.draw_still(pose, view, rows_.size(), grey_);
    write_grey_image(folder_ + "/images/" + picture.image, grey_.data(), camera.width_px, camera.height_px);
    rows_.push_back({picture, taught, back_truth(world, pose, view, taught)});
    if (on_progress_) on_progress_(rows_.size());
  }

  std::string folder_;
  std::uint64_t seed_;
  std::function<void(std::size_t)> on_progress_;
  std::vector<BackRow> rows_;
  std::vector<std::uint8_t> grey_;
};

}  // namespace

std::size_t write_back_set(const std::string& folder, std::uint64_t seed,
                           const std::function<void(std::size_t done)>& on_progress) {
  BackSet set(folder, seed, on_progress);
  set.add_stills();
  set.add_walk();
  return set.write_truth();
}

}  // namespace heel::evaluation
