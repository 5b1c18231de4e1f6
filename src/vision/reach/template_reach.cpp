#include "vision/reach/template_reach.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

#include "core/angles.h"
#include "core/frame_view.h"
#include "heel/error.h"
#include "heel/pose_tracker.h"
#include "vision/pose/average_back.h"
#include "vision/reach/back_picture.h"
#include "vision/reach/grey_texture.h"
#include "vision/template/reference_view.h"

namespace heel {
namespace {

constexpr double kDistances_m[] = {0.8, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0, 6.0};
constexpr double kTurnDistances_m[] = {TemplateReach::kTurnDistance_m, 3.0, 1.0, 4.0};
constexpr double kTurns_rad[] = {15 * kRadPerDeg, 30 * kRadPerDeg, 45 * kRadPerDeg, 60 * kRadPerDeg,
                                 75 * kRadPerDeg};
constexpr int kPicturesPerCell = 4;
constexpr int kMisses = 2;  // distances without a detection, one after the other: farther ones are not tried

// A detection that the robot uses, and what still counts as right.
constexpr double kMinCertainty = 0.1;
constexpr double kRightYaw_rad = 15 * kRadPerDeg, kRightDistanceShare = 0.1;

// Expected of a shirt; less is worth a warning.
constexpr double kGoodDistance_m = 3.0, kGoodTurn_rad = 40 * kRadPerDeg;

// The made pictures. The lens blurs by [1 2 1] / 4 pixels in both directions, a deviation of 0.7 pixels.
constexpr float kTexture_grey = 30.f, kNoise_grey = 2.f;
constexpr double kFolds_m = 0.006, kShortestFold_m = 0.12, kLongestFold_m = 0.35;
constexpr double kOffAxis =
    0.05;  // how far the back is from the middle of the picture, as a share of its distance
constexpr std::uint32_t kTextureSeed = 1;

struct Place {
  double distance_m, yaw_rad;
  int draw;  // which folds, place and noise
};

/// Makes the pictures of a template at a camera.
class ReachScene {
 public:
  ReachScene(const ShirtTemplate& shirt, const CameraModel& camera, const VisionConfig& config)
      : surface_(average_back(ReferenceView(shirt, config), config)),
        camera_(camera),
        distance_m_(shirt.distance_m),
        back_(shirt, surface_, camera),
        texture_(grey_texture(camera.width_px, camera.height_px, kTextureSeed)) {
    // The texture is as bright as the print, so that the print's edge is no cue.
    double sum = 0.0;
    for (int y = 0; y < shirt.roi.height_px; ++y)
      for (int x = 0; x < shirt.roi.width_px; ++x)
        sum += shirt.grey[static_cast<std::size_t>(shirt.roi.y_px + y) *
                              static_cast<std::size_t>(shirt.camera.width_px) +
                          static_cast<std::size_t>(shirt.roi.x_px + x)];
    const auto mean =
        static_cast<float>(sum / (static_cast<double>(shirt.roi.width_px) * shirt.roi.height_px));
    for (float& value : texture_) value = mean + kTexture_grey * value;
  }

  FrameView picture(const Place& place) {
    std::mt19937 random(static_cast<std::uint32_t>(place.draw));
    frame_ = texture_;
    const ClothFolds folds = some_folds(random);
    back_.draw(motion_to(place, random), folds, frame_);
    expose(random);
    return packed_frame(grey_.data(), camera_.width_px, camera_.height_px);
  }

 private:
  FrontalMotion motion_to(const Place& place, std::mt19937& random) const {
    std::uniform_real_distribution<double> off_axis(-kOffAxis, kOffAxis);
    const Eigen::Vector3d middle(surface_.axis_x, surface_.axis_y, 1.0);
    const double x = off_axis(random), y = off_axis(random);
    FrontalMotion motion;
    motion.R_cur_from_ref = Eigen::AngleAxisd(place.yaw_rad, Eigen::Vector3d::UnitY()).toRotationMatrix();
    motion.t_over_d =
        place.distance_m / distance_m_ * Eigen::Vector3d(x, y, 1.0) - motion.R_cur_from_ref * middle;
    return motion;
  }

  ClothFolds some_folds(std::mt19937& random) const {
    ClothFolds folds;
    std::uniform_real_distribution<double> length_m(kShortestFold_m, kLongestFold_m), angle(-M_PI, M_PI);
    for (ClothFolds::Wave& wave : folds.waves) {
      const double per_ray = 2.0 * M_PI * distance_m_ / length_m(random), direction = angle(random);
      wave.per_ray = per_ray * Eigen::Vector2d(std::cos(direction), std::sin(direction));
      wave.phase_rad = angle(random);
      wave.height = kFolds_m / distance_m_ * std::sqrt(2.0 / static_cast<double>(folds.waves.size()));
    }
    return folds;
  }

  /// Lens and sensor: frame_ → grey_.
  void expose(std::mt19937& random) {
    const auto width = static_cast<std::size_t>(camera_.width_px);
    const auto height = static_cast<std::size_t>(camera_.height_px);
    rows_.resize(frame_.size());
    grey_.resize(frame_.size());
    for (std::size_t y = 0; y < height; ++y) {
      const float* in = &frame_[y * width];
      for (std::size_t x = 0; x < width; ++x)
        rows_[y * width + x] = 0.25f * (in[x > 0 ? x - 1 : 0] + 2.f * in[x] + in[x + 1 < width ? x + 1 : x]);
    }
    std::normal_distribution<float> noise(0.5f, kNoise_grey);  // ½: the conversion below rounds down
    for (std::size_t y = 0; y < height; ++y) {
      const float* upper = &rows_[(y > 0 ? y - 1 : 0) * width];
      const float* middle = &rows_[y * width];
      const float* lower = &rows_[(y + 1 < height ? y + 1 : y) * width];
      for (std::size_t x = 0; x < width; ++x)
        grey_[y * width + x] = static_cast<std::uint8_t>(
            std::clamp(0.25f * (upper[x] + 2.f * middle[x] + lower[x]) + noise(random), 0.f, 255.f));
    }
  }

  BackSurface surface_;
  CameraModel camera_;
  double distance_m_;
  BackPicture back_;
  std::vector<float> texture_, frame_, rows_;
  std::vector<std::uint8_t> grey_;
};

/// The search for the back in pictures that have nothing to do with one another.
class ReachTrial {
 public:
  ReachTrial(const ShirtTemplate& shirt, const CameraModel& camera, VisionConfig config,
             const ReachProgress& progress)
      : scene_(shirt, camera, config), tracker_(shirt, camera, untracked(config)), progress_(progress) {}

  /// The cell, or nothing when it was stopped.
  std::optional<ReachCell> measure(double distance_m, double turn_rad) {
    ReachCell cell{distance_m, turn_rad, 0, 0};
    for (int i = 0; i < kPicturesPerCell; ++i) {
      if (stopped_) return std::nullopt;
      const Place place{distance_m, i % 2 == 0 ? turn_rad : -turn_rad, done_};
      cell.found += found_right(place);
      ++cell.pictures;
      stopped_ = !progress_(++done_, kMostPictures);
    }
    return cell;
  }
  bool stopped() const { return stopped_; }

 private:
  static constexpr int kMostPictures =
      kPicturesPerCell *
      static_cast<int>(std::size(kDistances_m) + std::size(kTurnDistances_m) * std::size(kTurns_rad));

  static VisionConfig untracked(VisionConfig config) {
    config.tracking = false;
    return config;
  }
  bool found_right(const Place& place) {
    const PoseEstimate pose = tracker_.estimate(scene_.picture(place));
    if (!pose.found() || pose.certainty < kMinCertainty) return false;
    return std::abs(pose.yaw_rad - place.yaw_rad) < kRightYaw_rad &&
           std::abs(pose.position_m[2] / place.distance_m - 1.0) < kRightDistanceShare;
  }

  ReachScene scene_;
  PoseTracker tracker_;
  const ReachProgress& progress_;
  int done_ = 0;
  bool stopped_ = false;
};

void find_longest_run(TemplateReach& reach) {
  const ReachCell* first = nullptr;
  for (const ReachCell& cell : reach.cells) {
    if (!cell.all_found()) {
      first = nullptr;
      continue;
    }
    if (first == nullptr) first = &cell;
    if (reach.far_m == 0.0 || cell.distance_m - first->distance_m > reach.far_m - reach.near_m) {
      reach.near_m = first->distance_m;
      reach.far_m = cell.distance_m;
    }
  }
}

bool always_found_facing_away(const TemplateReach& reach, double distance_m) {
  return std::any_of(reach.cells.begin(), reach.cells.end(), [&](const ReachCell& cell) {
    return cell.turn_rad == 0.0 && cell.distance_m == distance_m && cell.all_found();
  });
}

}  // namespace

TemplateReach measure_reach(const ShirtTemplate& shirt, const CameraModel& camera, const VisionConfig& config,
                            const ReachProgress& progress) {
  if (!(shirt.distance_m > 0.0))
    throw Error("template: distance not known (expected metres above 0, to measure how far it is found)");
  TemplateReach reach;
  ReachTrial trial(shirt, camera, config, progress);
  int misses = 0;
  for (const double distance_m : kDistances_m) {
    if (misses >= kMisses && distance_m > shirt.distance_m) break;
    const std::optional<ReachCell> cell = trial.measure(distance_m, 0.0);
    if (!cell) break;
    reach.cells.push_back(*cell);
    misses = cell->found > 0 ? 0 : misses + 1;
  }
  find_longest_run(reach);
  for (const double distance_m : kTurnDistances_m) {
    bool always = always_found_facing_away(reach, distance_m);
    if (always && distance_m == TemplateReach::kTurnDistance_m) reach.turn_rad = 0.0;
    for (const double turn_rad : kTurns_rad) {
      const std::optional<ReachCell> cell = trial.measure(distance_m, turn_rad);
      if (!cell) break;
      reach.cells.push_back(*cell);
      always = always && cell->all_found();
      if (always && distance_m == TemplateReach::kTurnDistance_m) reach.turn_rad = turn_rad;
      if (cell->found == 0) break;
    }
  }
  reach.complete = !trial.stopped();
  if (!reach.complete && reach.turn_rad == 0.0) reach.turn_rad.reset();  // no turn was measured
  return reach;
}

std::string reach_warning(const TemplateReach& reach) {
  if (!reach.complete) return {};
  const bool far = reach.far_m >= kGoodDistance_m, turned = reach.turn_rad.value_or(0.0) >= kGoodTurn_rad;
  if (far && turned) return {};
  const std::string found_less = far      ? "it is lost before it turns by 40°"
                                 : turned ? "it is lost before 3 m"
                                          : "it is lost before 3 m and before it turns by 40°";
  return "the print is small or low in contrast: " + found_less +
         " (a larger or bolder print, even light, or more pixels help)";
}

}  // namespace heel
