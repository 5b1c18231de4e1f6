#include "evaluation/experiments/still_image_cases.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "core/angles.h"
#include "core/random.h"
#include "sim/lockstep/lockstep.h"

namespace heel::evaluation {
namespace {

constexpr double kPaperDistance_m = 2.0;  ///< "approximately 2 m" in the paper's lateral and yaw experiments

std::uint64_t seed_of(int repeat) {
  return static_cast<std::uint64_t>(1 + repeat % kMaxWorlds);
}

std::vector<StillImageCase> repeated(const std::vector<StillImageView>& views, const char* name,
                                     int repeats) {
  std::vector<StillImageCase> cases;
  for (const StillImageView& view : views)
    for (int i = 0; i < repeats; ++i) cases.push_back({name, {seed_of(i), "bold", 1.0}, view});
  return cases;
}

std::vector<StillImageCase> lateral_cases(int repeats) {
  std::vector<StillImageView> views;
  for (int i = -4; i <= 4; ++i) views.push_back({.x_m = 0.2 * i, .z_m = kPaperDistance_m});
  return repeated(views, "lateral", repeats);
}

std::vector<StillImageCase> distance_cases(int repeats) {
  std::vector<StillImageView> views;
  for (int i = 2; i <= 12; ++i) views.push_back({.z_m = 0.5 * i});
  return repeated(views, "distance", repeats);
}

std::vector<StillImageCase> yaw_cases(int repeats) {
  std::vector<StillImageView> views;
  for (int deg = -85; deg <= 85; deg += 5)
    if (std::abs(deg) > 60 || deg % 20 == 0)
      views.push_back({.z_m = kPaperDistance_m, .yaw_rad = kRadPerDeg * deg});
  return repeated(views, "yaw", repeats);
}

std::vector<StillImageCase> hard_cases(int /*repeats*/) {
  const auto deg = [](double value) { return kRadPerDeg * value; };
  return {
      {"straight ahead at 2 m", {1, "bold", 1.0}, {.z_m = 2.0}},
      {"turned away by 55 deg", {2, "bold", 1.0}, {.z_m = 2.0, .yaw_rad = deg(55)}},
      {"turned by -65 deg", {3, "bold", 1.0}, {.z_m = 1.8, .yaw_rad = deg(-65)}},
      {"3.5 m away", {4, "bold", 1.0}, {.x_m = 0.3, .z_m = 3.5, .yaw_rad = deg(15)}},
      {"3 m away and turned", {5, "bold", 1.0}, {.x_m = -0.8, .z_m = 3.0, .yaw_rad = deg(-35)}},
      {"at the edge of the view", {6, "bold", 1.0}, {.x_m = -0.95, .z_m = 2.2, .yaw_rad = deg(-10)}},
      {"1 m and partly out of view", {7, "bold", 1.0}, {.x_m = 0.42, .z_m = 1.0, .yaw_rad = deg(20)}},
      {"smeared over 7 px", {8, "bold", 1.0}, {.z_m = 1.8, .yaw_rad = deg(25), .blur_px = 7.0}},
      {"a fifth of the light", {1, "bold", 0.2}, {.x_m = 0.2, .z_m = 2.0, .yaw_rad = deg(-20)}},
      {"half behind a board", {2, "bold", 1.0}, {.z_m = 1.8, .yaw_rad = deg(10), .occluded = 0.5}},
      {"another print; turned", {3, "mosaic", 1.0}, {.x_m = 0.3, .z_m = 2.5, .yaw_rad = deg(40)}},
      {"dark; smeared; covered",
       {4, "bold", 0.5},
       {.x_m = -0.3, .z_m = 2.0, .yaw_rad = deg(-30), .blur_px = 3.0, .occluded = -0.3}},
  };
}

/// `repeats` thousand poses in the whole range in which the robot may follow: 45 % of them undisturbed, 15 %
/// each blurred, dark or covered, 10 % all three.
std::vector<StillImageCase> errors_cases(int repeats) {
  constexpr std::array<double, 4> kLights{0.5, 0.25, 0.12, 0.06};
  constexpr std::array<const char*, 2> kShirts{"bold", "mosaic"};
  constexpr double kWidestBearing_rad = 25.0 * kRadPerDeg;
  Random random(0xe44);
  std::vector<StillImageCase> cases;
  for (int i = 0; i < 1000 * repeats; ++i) {
    StillImageCase drawn;
    drawn.name = "errors";
    drawn.world.seed = seed_of(random.index(kMaxWorlds));
    drawn.world.shirt = kShirts[static_cast<std::size_t>(random.uniform() < 0.25 ? 1 : 0)];
    drawn.view.z_m = random.uniform(0.9, 5.5);
    drawn.view.x_m = drawn.view.z_m * std::tan(random.uniform(-kWidestBearing_rad, kWidestBearing_rad));
    drawn.view.yaw_rad = random.uniform(-80.0 * kRadPerDeg, 80.0 * kRadPerDeg);
    const double disturbed = random.uniform();
    const bool together = disturbed > 0.9;
    if ((disturbed > 0.45 && disturbed < 0.6) || together) drawn.view.blur_px = random.uniform(0.5, 9.0);
    if ((disturbed > 0.6 && disturbed < 0.75) || together)
      drawn.world.light = kLights[static_cast<std::size_t>(random.index(4))];
    if ((disturbed > 0.75 && disturbed < 0.9) || together)
      drawn.view.occluded = (random.uniform() < 0.5 ? -1.0 : 1.0) * random.uniform(0.05, 0.7);
    cases.push_back(drawn);
  }
  return cases;
}

}  // namespace

const std::vector<StillImageExperiment>& still_image_experiments() {
  static const std::vector<StillImageExperiment> kExperiments{
      {"lateral", "t_x and yaw at sideways offsets, 2 m away", lateral_cases, 24, false},
      {"distance", "t_z and yaw from 1 to 6 m", distance_cases, 24, false},
      {"yaw", "yaw in 20 degree steps to 60, then in steps of 5 to where it fails", yaw_cases, 24, false},
      {"hard", "twelve hard cases with their pictures", hard_cases, 1, true},
      {"errors", "errors over distance, yaw, blur, light, shirt and occlusion; thousands of poses",
       errors_cases, 3, false},
  };
  return kExperiments;
}

std::vector<StillImageRow> run_still_images(const sim::Scenario& base,
                                            const std::vector<StillImageCase>& cases, double teach_distance_m,
                                            const VisionConfig& vision, const PictureCallback& on_picture,
                                            const ProgressCallback& on_progress) {
  // World by world, because a world is slow to make and large. Rows are in the order of the cases.
  std::map<StillImageWorld, std::vector<std::size_t>> cases_of_world;
  for (std::size_t i = 0; i < cases.size(); ++i) cases_of_world[cases[i].world].push_back(i);
  std::vector<StillImageRow> rows(2 * cases.size());
  std::map<StillImageWorld, ShirtTemplate> templates;
  std::size_t done = 0;
  for (const auto& [world, indices] : cases_of_world) {
    const StillImageWorld bright{world.seed, world.shirt, 1.0};
    if (!templates.contains(bright))
      templates[bright] = sim::teach_from_world(still_image_scenario(base, bright), teach_distance_m);
    StillImageScene scene(base, world, templates[bright], vision);
    for (const std::size_t i : indices) {
      const auto pair = scene.estimate_pair(cases[i].name, cases[i].view);
      rows[2 * i] = pair[0];
      rows[2 * i + 1] = pair[1];
      if (on_picture) on_picture(i, scene.grey());
    }
    done += indices.size();
    if (on_progress) on_progress(done, cases.size());
  }
  return rows;
}

}  // namespace heel::evaluation
