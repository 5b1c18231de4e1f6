// An hour of light that turns from frontal to lateral, dims and changes its colour, on a back that turns.
// heel does not adapt the template to the light, so that it cannot drift to another shirt: the taught picture
// has to be enough.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "heel/pose_tracker.h"
#include "support/sanitized.h"
#include "vision/pose/average_back.h"
#include "vision/pose/rendered_back.h"

namespace heel {
namespace {

using test::robot_camera;
using test::shirt;
using test::t_over_d_for;

/// At the start the light of the taught picture; each member grows to its value at the end.
struct Light {
  double turned_rad = 0.0;  ///< from the optical axis to the right
  double brightness = 1.0;
  double gamma = 1.0;
  double other_inks = 0.0;  ///< how much brighter the inks that the second texture shows have become
};

constexpr double kAmbient = 0.25;
constexpr double kMeanGrey = 110.0;                 // that automatic exposure and gain aim at
constexpr double kLargestGain = 6.0, kNoise = 2.0;  // the noise grows with the gain
constexpr double kAfterAnHour_rad = 1.2;

Light light_at(double share_of_hour) {
  return {kAfterAnHour_rad * share_of_hour, 1.0 - 0.7 * share_of_hour, 1.0 + 0.4 * share_of_hour,
          0.25 * share_of_hour};
}

/// The print on the surface turned by R, as a camera with automatic exposure and gain sees it in `light`.
ShirtTemplate lit(const ShirtTemplate& taught, const BackSurface& surface, const Eigen::Matrix3d& R,
                  const Light& light) {
  ShirtTemplate shown = taught;
  std::vector<double> level(taught.grey.size());
  double sum = 0.0;
  const Eigen::Matrix3d K_inverse = taught.camera.K().inverse();
  const Eigen::Vector3d to_light(std::sin(light.turned_rad), 0.0, -std::cos(light.turned_rad));
  const cv::Mat inks = test::texture(31, taught.camera.width_px, taught.camera.height_px);
  for (int y = 0; y < taught.camera.height_px; ++y) {
    for (int x = 0; x < taught.camera.width_px; ++x) {
      const auto i = static_cast<std::size_t>(y * taught.camera.width_px + x);
      const Eigen::Vector3d ray =
          K_inverse *
          taught.camera.undistort_px({static_cast<double>(x), static_cast<double>(y)}).homogeneous();
      const Eigen::Matrix<double, 3, 2> along = surface.derivative(ray);
      const Eigen::Vector3d normal = R * along.col(1).cross(along.col(0)).normalized();
      const double shade = kAmbient + (1.0 - kAmbient) * std::max(0.0, normal.dot(to_light));
      const double ink = taught.grey[i] + light.other_inks * (inks.at<std::uint8_t>(y, x) - 128.0);
      const double reflected = std::pow(std::clamp(ink / 255.0, 0.0, 1.0), light.gamma);
      level[i] = 255.0 * light.brightness * shade * reflected;
      sum += level[i];
    }
  }
  const double gain = std::min(kLargestGain, kMeanGrey * static_cast<double>(level.size()) / sum);
  cv::RNG noise(static_cast<std::uint64_t>(1e6 * light.brightness));
  for (std::size_t i = 0; i < level.size(); ++i)
    shown.grey[i] = cv::saturate_cast<std::uint8_t>(gain * level[i] + noise.gaussian(kNoise * gain));
  return shown;
}

TEST(Light, AnHourOfItNeedsNoOtherPictureThanTheTaughtOne) {
  constexpr int kMinutes = 60, kStep_min = test::kSanitized ? 20 : 2;
  const ShirtTemplate taught = shirt();
  const BackSurface surface = average_back(ReferenceView(taught, VisionConfig{}), VisionConfig{});
  PoseTracker tracker(taught, robot_camera(), VisionConfig{});
  double first_rad = 0.0, last_rad = 0.0, worst_rad = 0.0;
  int found = 0, frames = 0;
  for (int minute = 0; minute <= kMinutes; minute += kStep_min) {
    const double yaw_rad = 0.6 * std::sin(0.7 * minute), depth = 1.3 + 0.3 * std::cos(0.4 * minute);
    const Eigen::Matrix3d R = test::rotation(yaw_rad, 0.0, 0.0);
    const ShirtTemplate shown = lit(taught, surface, R, light_at(static_cast<double>(minute) / kMinutes));
    const cv::Mat image = test::render_back(shown, surface, R, t_over_d_for(R, 0.05, depth), 5);
    for (int frame = 0; frame < 2; ++frame) {  // the first one is searched, in the second it is tracked
      FrameView view = test::view_of(image);
      view.header.t_capture_ns = minute * 60 * kNsPerS + frame * kNsPerS / 30;
      const PoseEstimate pose = tracker.estimate(view);
      ++frames;
      EXPECT_TRUE(pose.found()) << "minute " << minute << ": " << to_string(pose.reason);
      if (!pose.found()) continue;
      ++found;
      const double error_rad = std::abs(pose.yaw_rad - yaw_rad);
      worst_rad = std::max(worst_rad, error_rad);
      (minute < kMinutes / 2 ? first_rad : last_rad) += error_rad;
    }
  }
  std::cout << "found in " << found << " of " << frames << " frames; mean yaw error of the first half hour "
            << 2.0 * first_rad / frames * 180.0 / M_PI << " deg, of the second "
            << 2.0 * last_rad / frames * 180.0 / M_PI << " deg, largest " << worst_rad * 180.0 / M_PI
            << " deg\n";
  EXPECT_EQ(found, frames);
  EXPECT_LT(worst_rad, 0.07);
}

}  // namespace
}  // namespace heel
