#include "distance_by_driving.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "camera_look.h"
#include "heel/error.h"
#include "ticked_link.h"
#include "vision/pose/template_selector.h"

namespace heel::cli {
namespace {

constexpr double kBack_m = 0.5, kBackwards_m_s = 0.1;
constexpr double kLeastDriven_m = 0.3;
constexpr TimeNs kLongestDrive_ns = 10 * kNsPerS, kToRest_ns = kNsPerS;
constexpr double kLeastShareFound = 0.5, kLargestSigmaShare = 0.1;

double driven_between(const Odometry& before, const Odometry& after) {
  return -((after.x_m - before.x_m) * std::cos(before.heading_rad) +
           (after.y_m - before.y_m) * std::sin(before.heading_rad));
}

double drive_back(const Config& config) {
  TickedLink link(config.robot);
  PreflightStep step{.name = "robot"};
  if (!require_running(link, config.robot, step)) throw Error(step.measured + "; " + step.advice);
  const Odometry before = link.state().odometry;
  const auto touched = [&] {
    const RobotState& state = link.state();
    return state.bumpers_front != 0 || state.bumpers_rear != 0 || state.stall_left || state.stall_right ||
           state.phase != LinkPhase::Running;
  };
  const auto far_enough = [&] {
    return touched() || driven_between(before, link.state().odometry) >= kBack_m;
  };
  if (touched()) throw Error("a bumper is pressed or a wheel is stalled: nothing was moved");
  link.run(-kBackwards_m_s, 0.0, kLongestDrive_ns, far_enough);
  const bool was_touched = touched();
  link.run(0.0, 0.0, kToRest_ns, [] { return false; });
  const double driven_m = driven_between(before, link.state().odometry);
  if (was_touched || driven_m < kLeastDriven_m)
    throw Error(fmt::format("the robot drove back only {:.2f} m{} (expected {:g} m; is it free behind it?)",
                            driven_m, was_touched ? ", a bumper, a stall or the motors stopped it" : "",
                            kBack_m));
  return driven_m;
}

struct Moved {
  double t_z_over_d = 0.0, sigma = 0.0;
};

/// How far away the shirt is now, beyond where it was, in units of the distance.
Moved moved_away(const ShirtTemplate& shirt, const Config& config) {
  const std::vector<ShirtTemplate> shirts{shirt};
  TemplateSelector vision(shirts, shirt.camera, config.vision);
  std::vector<Moved> found;
  Look look(config.camera);
  look.take([&](const FrameView& frame) {
    const PoseEstimate pose = vision.estimate(frame);
    if (pose.found()) found.push_back({pose.t_over_d[2], pose.t_over_d_sigma[2]});
  });
  if (static_cast<double>(found.size()) < kLeastShareFound * static_cast<double>(look.frames()))
    throw Error(
        fmt::format("the shirt is found in {} of {} pictures from farther away (expected half of them)",
                    found.size(), look.frames()));
  const auto middle = found.begin() + static_cast<std::ptrdiff_t>(found.size() / 2);
  std::ranges::nth_element(found, middle, {}, &Moved::t_z_over_d);
  return *middle;
}

}  // namespace

DrivenDistance distance_by_driving_back(const ShirtTemplate& shirt, const Config& config) {
  DrivenDistance result;
  result.driven_m = drive_back(config);
  const Moved moved = moved_away(shirt, config);
  // X_cur = R X_ref + t: of a person who stands still, t is the camera's own way back along its axis.
  const double along_axis_m =
      result.driven_m * std::cos(config.camera.mount_yaw_rad) * std::cos(config.camera.mount_pitch_rad);
  if (!(moved.t_z_over_d > 0.0) || moved.sigma > kLargestSigmaShare * moved.t_z_over_d)
    throw Error(
        fmt::format("the shirt does not become smaller as it should: t_z / d = {:.3f} ± {:.3f} after {:.2f} "
                    "m (expected the person to stand still)",
                    moved.t_z_over_d, moved.sigma, result.driven_m));
  result.distance_m = along_axis_m / moved.t_z_over_d;
  result.sigma_m = result.distance_m * moved.sigma / moved.t_z_over_d;
  return result;
}

}  // namespace heel::cli
