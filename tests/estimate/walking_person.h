// A person who walks, and what a camera that follows 1.8 m behind measures of their back. The figures are
// those of people and of cloth: the yaw swings by 5 to 9° with each stride and the back sways by 2 to 5 cm,
// both with a stride that is never quite the same; the mean yaw of the back is not that of the path, the
// taught cloth adds a lasting error, and the cloth that moves now adds one that is gone after a fifth of a
// second.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "core/angles.h"
#include "core/random.h"
#include "estimate/travel_filter.h"

namespace heel::test {

/// A part of a walk.
struct WalkPart {
  double duration_s = 0.0;
  double speed_m_s = 0.0;     ///< forwards
  double turn_rad_s = 0.0;    ///< at that speed; of a person who stands, on the spot
  double sideways_m_s = 0.0;  ///< to the left
};

/// Straight parts, bends of 17 to 92°, stops and turns on the spot, at the pace of one person.
inline std::vector<WalkPart> any_walk(Random& random) {
  const double pace_m_s = random.uniform(0.4, 1.4);
  std::vector<WalkPart> parts{{1.0}};
  for (int i = 0; i < 11; ++i) {
    const double kind = random.uniform();
    const double side = random.uniform() < 0.5 ? -1.0 : 1.0;
    const double speed_m_s = pace_m_s * random.uniform(0.7, 1.1);
    const double radius_m = random.uniform(0.8, 4.0) * std::max(1.0, speed_m_s / 0.8);
    const double turn_rad_s = std::min(0.8, speed_m_s / radius_m);
    if (kind < 0.40)
      parts.push_back({random.uniform(1.5, 5.0), speed_m_s});
    else if (kind < 0.75)
      parts.push_back({random.uniform(0.3, 1.6) / turn_rad_s, speed_m_s, side * turn_rad_s});
    else if (kind < 0.90)
      parts.push_back({random.uniform(1.0, 3.0)});
    else
      parts.push_back({2.0, 0.0, random.uniform(-0.5, 0.5)});
  }
  return parts;
}

/// A value that is correlated over `memory_s`, with deviation 1.
class CorrelatedNoise {
 public:
  CorrelatedNoise(Random& random, double memory_s)
      : random_(random), memory_s_(memory_s), value_(random.normal()) {}
  double next(double dt_s) {
    const double kept = std::exp(-dt_s / memory_s_);
    return value_ = kept * value_ + std::sqrt(1.0 - kept * kept) * random_.normal();
  }

 private:
  Random& random_;
  double memory_s_;
  double value_;
};

struct WalkTruth {
  double t_s = 0.0;
  double travel_rad = 0.0;         ///< direction of travel
  double stride_travel_rad = 0.0;  ///< its mean over the last 1.2 s
  double back_rad = 0.0;           ///< yaw of the back
  double speed_m_s = 0.0;
  double turn_rad_s = 0.0;
  double x_m = 0.0, y_m = 0.0;  ///< axis of the body, without sway
};

class WalkingPerson {
 public:
  static constexpr double kStep_s = 1.0 / 240.0;

  WalkingPerson(const std::vector<WalkPart>& parts, Random& random) : random_(random), parts_(parts) {
    place_.heading_rad = random.uniform(-3.0, 3.0);
    camera_m_ = -kCameraBehind_m * unit(place_.heading_rad);
  }

  /// The next moment of the walk; false after its end.
  bool step() {
    while (part_ < parts_.size() && t_part_s_ >= parts_[part_].duration_s) {
      t_part_s_ -= parts_[part_++].duration_s;
    }
    if (part_ == parts_.size()) return false;
    t_part_s_ += kStep_s;
    walk(parts_[part_]);
    return true;
  }

  const WalkTruth& truth() const { return truth_; }

  /// One frame, `dt_s` after the last.
  BackMeasurement measure(double dt_s) {
    const Eigen::Vector2d t = unit(truth_.travel_rad);
    const Eigen::Vector2d n(-t.y(), t.x());
    const double sway_m = gait() * sway_m_ * unevenness() * std::sin(stride_rad_);
    const double bob_m = gait() * 0.012 * std::sin(2.0 * stride_rad_ + 1.0);
    const Eigen::Vector2d back_m = Eigen::Vector2d(place_.x_m, place_.y_m) + sway_m * n + bob_m * t -
                                   axis_to_back_m_ * unit(truth_.back_rad);
    const Eigen::Vector2d ray = (back_m - camera_m_).normalized();
    const double range_m = (back_m - camera_m_).norm();
    BackMeasurement back;
    back.position_m = back_m + 0.025 * along_noise_.next(dt_s) * ray +
                      0.004 * random_.normal() * Eigen::Vector2d(-ray.y(), ray.x());
    const Eigen::Matrix2d R = Eigen::Rotation2Dd(std::atan2(ray.y(), ray.x())).toRotationMatrix();
    back.R_position =
        R * Eigen::Vector2d(std::pow(0.02 * range_m, 2) + 1e-4, 2e-4).asDiagonal() * R.transpose();
    back.yaw_rad = truth_.back_rad + cloth_bias_rad_ + cloth_rad_ * cloth_noise_.next(dt_s) +
                   gait() * cloth_swing_rad_ * std::sin(stride_rad_ + cloth_phase_rad_);
    back.yaw_sigma_rad = stated_sigma_rad_;
    return back;
  }

 private:
  static constexpr double kCameraBehind_m = 1.8;
  static constexpr double kStride_s = 1.2;

  static Eigen::Vector2d unit(double angle_rad) { return {std::cos(angle_rad), std::sin(angle_rad)}; }
  double gait() const { return std::min(1.0, truth_.speed_m_s / 0.5); }
  double unevenness() const { return 1.0 + 0.15 * uneven_; }

  void walk(const WalkPart& part) {
    const double limit_m_s = acceleration_m_s2_ * kStep_s;
    truth_.t_s += kStep_s;
    truth_.speed_m_s += std::clamp(part.speed_m_s - truth_.speed_m_s, -limit_m_s, limit_m_s);
    const double turn_rad_s =
        part.speed_m_s > 0.0 ? part.turn_rad_s * truth_.speed_m_s / part.speed_m_s : part.turn_rad_s;
    truth_.turn_rad_s += std::clamp(turn_rad_s - truth_.turn_rad_s, -2.5 * kStep_s, 2.5 * kStep_s);
    place_.heading_rad += truth_.turn_rad_s * kStep_s;
    const Eigen::Vector2d t = unit(place_.heading_rad);
    place_.x_m += kStep_s * (truth_.speed_m_s * t.x() - part.sideways_m_s * t.y());
    place_.y_m += kStep_s * (truth_.speed_m_s * t.y() + part.sideways_m_s * t.x());
    truth_.travel_rad = place_.heading_rad;
    truth_.x_m = place_.x_m;
    truth_.y_m = place_.y_m;
    headings_.push_back(place_.heading_rad);

    uneven_ = uneven_noise_.next(kStep_s);
    if (truth_.speed_m_s > 0.03) {
      stride_rad_ +=
          std::numbers::pi * (0.9 + 0.75 * truth_.speed_m_s) * cadence_ * (1.0 + 0.1 * uneven_) * kStep_s;
    }
    const double swing_rad = swing_rad_ * unevenness() *
                             (std::sin(stride_rad_ + swing_phase_rad_) +
                              harmonic_ * std::sin(2.0 * stride_rad_ + cloth_phase_rad_));
    truth_.back_rad = place_.heading_rad + gait() * swing_rad + back_bias_rad_ * (0.5 + 0.5 * gait());

    const std::size_t window = std::min(headings_.size(), static_cast<std::size_t>(kStride_s / kStep_s));
    sum_rad_ += place_.heading_rad;
    if (headings_.size() > window) sum_rad_ -= headings_[headings_.size() - 1 - window];
    truth_.stride_travel_rad = sum_rad_ / static_cast<double>(window);

    const Eigen::Vector2d to_person_m = Eigen::Vector2d(place_.x_m, place_.y_m) - camera_m_;
    const double too_far_m = to_person_m.norm() - kCameraBehind_m;
    if (too_far_m > 0.0) camera_m_ += too_far_m * to_person_m.normalized();
  }

  struct Place {
    double x_m = 0.0, y_m = 0.0, heading_rad = 0.0;
  };

  Random& random_;
  std::vector<WalkPart> parts_;
  std::size_t part_ = 0;
  double t_part_s_ = 0.0;
  Place place_;
  WalkTruth truth_;
  Eigen::Vector2d camera_m_;
  std::vector<double> headings_;
  double sum_rad_ = 0.0;

  // The person.
  double acceleration_m_s2_ = random_.uniform(0.6, 1.2);
  double cadence_ = random_.uniform(0.85, 1.15);
  double stride_rad_ = random_.uniform(0.0, 6.3);
  double swing_rad_ = random_.uniform(5.0, 9.0) * kRadPerDeg;
  double swing_phase_rad_ = random_.uniform(0.0, 6.3);
  double harmonic_ = random_.uniform(0.0, 0.25);
  double sway_m_ = random_.uniform(0.02, 0.05);
  double axis_to_back_m_ = random_.uniform(0.08, 0.15);
  double back_bias_rad_ = 2.0 * kRadPerDeg * random_.normal();
  CorrelatedNoise uneven_noise_{random_, 1.0};
  double uneven_ = 0.0;
  // Vision.
  double cloth_bias_rad_ = 1.5 * kRadPerDeg * random_.normal();
  double cloth_rad_ = random_.uniform(2.0, 4.0) * kRadPerDeg;
  double cloth_swing_rad_ = 2.0 * kRadPerDeg;
  double cloth_phase_rad_ = random_.uniform(0.0, 6.3);
  CorrelatedNoise cloth_noise_{random_, 0.13};
  CorrelatedNoise along_noise_{random_, 0.2};
  double stated_sigma_rad_ =
      std::hypot(cloth_rad_, cloth_swing_rad_ / std::numbers::sqrt2) * random_.uniform(0.9, 1.1);
};

}  // namespace heel::test
