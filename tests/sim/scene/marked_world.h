// A person in the shirt with the dots, and whether a picture shows the dots where the truth says.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "sim/scene/shirts.h"
#include "sim/scene/world.h"

namespace heel::test {

inline sim::Scenario marked_scenario() {
  sim::Scenario scenario;
  scenario.person.shirt = sim::ShirtDesign::Marked;
  scenario.camera.model = sim::default_camera_model();
  scenario.camera.sensor.exposure_ms = 0.0;
  scenario.room.objects = 10;
  sim::WalkItem ahead;
  ahead.length_m = 10;
  scenario.path = {ahead};
  return scenario;
}

/// Centre of what is bright about `around`, weighted by how bright; NaN when nothing is.
inline Eigen::Vector2d bright_centre(const std::vector<std::uint8_t>& grey, int width,
                                     const Eigen::Vector2d& around) {
  Eigen::Vector2d sum(0, 0);
  double weight = 0;
  constexpr int kRadius = 11;
  const int cx = static_cast<int>(std::lround(around.x()));
  const int cy = static_cast<int>(std::lround(around.y()));
  for (int y = cy - kRadius; y <= cy + kRadius; ++y)
    for (int x = cx - kRadius; x <= cx + kRadius; ++x) {
      const double w = std::max(0.0, grey[static_cast<std::size_t>(y) * width + x] - 120.0);
      sum += w * Eigen::Vector2d(x, y);
      weight += w;
    }
  return sum / weight;
}

struct PictureMoment {
  double t_s;
  sim::RobotMotion robot;
};

/// Where the picture must show a dot of the shirt, by the world's own truth of it.
inline bool mark_px(const sim::World& world, const PictureMoment& view, int mark, Eigen::Vector2d& px) {
  const sim::ShirtMark at = sim::shirt_mark(mark);
  return world.pixel_of_moving_point(
      view.robot, view.t_s,
      [&](double t_s) -> Eigen::Vector3d {
        const sim::PersonPose person = world.person_pose(t_s);
        return person.world_from_part[sim::kTorso] *
               world.person().shirt_point_m(at.s_texel, at.t_texel, person.cloth);
      },
      px);
}

/// Every dot in every view within `tolerance_px` of where the truth puts it.
inline void expect_marks_at_truth(const sim::Scenario& scenario, const std::vector<PictureMoment>& views,
                                  double tolerance_px) {
  sim::World world(scenario);
  world.start_walk(0.0);
  std::vector<std::uint8_t> grey;
  int seen = 0;
  for (const PictureMoment& view : views) {
    world.render(view.robot, view.t_s, 0, grey);
    for (int i = 0; i < sim::kShirtMarks; ++i) {
      Eigen::Vector2d px;
      if (!mark_px(world, view, i, px)) continue;
      if (px.x() < 20 || px.y() < 20 || px.x() > 620 || px.y() > 460) continue;
      const Eigen::Vector2d found = bright_centre(grey, 640, px);
      EXPECT_LT((found - px).norm(), tolerance_px)
          << "mark " << i << " at t " << view.t_s << ": " << found.transpose() << " for " << px.transpose();
      ++seen;
    }
  }
  EXPECT_GT(seen, sim::kShirtMarks * static_cast<int>(views.size()) * 2 / 3);
}

}  // namespace heel::test
