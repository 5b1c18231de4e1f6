#include "control/trail.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "core/angles.h"

namespace heel {
namespace {

// The trail's end direction is taken over this length.
constexpr double kEnd_m = 0.2;
// The lead-in is revised until the trail has this length.
constexpr double kLeadInRevised_m = 0.8;
// A person who stands moves the first point, up to this far.
constexpr double kStanding_m = 0.1;
constexpr double kAside_m = 0.12;
// Directions that differ by more than this many deviations are different ones.
constexpr double kClearlyOther = 3.0;
// Keeps the quadratic flat where the points do not determine it; far below what it is worth elsewhere.
constexpr double kFlatness = 1e-3;

Eigen::Vector2d unit(double angle_rad) {
  return {std::cos(angle_rad), std::sin(angle_rad)};
}

}  // namespace

bool Trail::add(const Eigen::Vector2d& body_m, double travel_rad, double travel_sigma_rad,
                const Pose2& robot) {
  if (!body_m.allFinite() || !std::isfinite(travel_rad) || !std::isfinite(travel_sigma_rad)) return true;
  const bool again = empty() || (body_m - point(size_ - 1).at_m).norm() > kLongestGap_m;
  if (again) first_seen_m_ = body_m;
  if (again || (size_ == 1 && (body_m - first_seen_m_).norm() < kStanding_m)) start(body_m, robot);
  if (tip_m() - first_m() < kLeadInRevised_m && first_m() == 0.0) set_lead_in(travel_rad, travel_sigma_rad);
  while (size_ > 1 && (body_m - point(size_ - 1).at_m).dot(end_direction()) < -kSpacing_m) --size_;
  const Eigen::Vector2d step_m = body_m - point(size_ - 1).at_m;
  if (size_ == 1 && step_m.dot(end_direction()) < -kSpacing_m) {
    start(body_m, robot);  // behind the whole trail
    return false;
  }
  extend(step_m);
  beyond_last_m_ = (body_m - point(size_ - 1).at_m).dot(end_direction());
  return !again;
}

/// Adds points up to a place. Those in between fill a gap, so that every stretch of the trail has its weight.
void Trail::extend(const Eigen::Vector2d& step_m) {
  const double length_m = step_m.norm();
  // Standing people move a little to each side; a step aside is longer.
  const bool goes_on = step_m.dot(end_direction()) > 0.5 * length_m || length_m > kAside_m;
  if (!goes_on) return;
  const int steps = static_cast<int>(length_m / kSpacing_m);
  const Eigen::Vector2d from_m = point(size_ - 1).at_m;
  for (int i = 1; i <= steps; ++i) push(from_m + (i * kSpacing_m / length_m) * step_m);
}

void Trail::start(const Eigen::Vector2d& body_m, const Pose2& robot) {
  begin_ = 0;
  size_ = 1;
  ring_[0] = {body_m, 0.0};
  beyond_last_m_ = 0.0;
  from_robot_rad_ = std::atan2(body_m.y() - robot.y_m, body_m.x() - robot.x_m);
  lead_in_ = unit(from_robot_rad_);
}

void Trail::push(const Eigen::Vector2d& at_m) {
  const double s_m = last_m() + (at_m - point(size_ - 1).at_m).norm();
  if (size_ == kCapacity) {
    begin_ = (begin_ + 1) % kCapacity;
    --size_;
  }
  point(size_++) = {at_m, s_m};
}

/// From the robot's first place while the direction of travel may be the same; along that direction when it
/// differs clearly.
void Trail::set_lead_in(double travel_rad, double travel_sigma_rad) {
  const double difference_rad = wrap_angle_rad(travel_rad - from_robot_rad_);
  const double deviations = difference_rad / (kClearlyOther * std::max(travel_sigma_rad, 1e-3));
  const double share = 1.0 - std::exp(-std::pow(deviations, 6));
  lead_in_ = unit(from_robot_rad_ + share * difference_rad);
}

Eigen::Vector2d Trail::end_direction() const {
  const auto back = std::min(size_ - 1, static_cast<std::size_t>(kEnd_m / kSpacing_m));
  const Eigen::Vector2d chord_m = point(size_ - 1).at_m - point(size_ - 1 - back).at_m;
  return back == 0 || chord_m.norm() < 1e-6 ? lead_in_ : chord_m.normalized();
}

std::size_t Trail::first_at_or_after(double s_m) const {
  std::size_t low = 0, high = size_;
  while (low < high) {
    const std::size_t middle = (low + high) / 2;
    if (point(middle).s_m < s_m)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

Trail::Place Trail::at(double s_m, double half_width_m) const {
  const double centre_m = std::min(s_m, last_m());
  // Normal equations of x(u), y(u) = c0 + c1 u + c2 u², u = (s − centre) / half width.
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Matrix<double, 3, 2> right = Eigen::Matrix<double, 3, 2>::Zero();
  const Eigen::Vector2d origin_m = point(0).at_m;
  const auto include = [&](double at_s_m, const Eigen::Vector2d& at_m) {
    const double u = (at_s_m - centre_m) / half_width_m;
    const double near = 1.0 - u * u;
    if (near <= 0.0) return;
    const Eigen::Vector3d basis(1.0, u, u * u);
    normal += near * near * basis * basis.transpose();
    right += near * near * basis * (at_m - origin_m).transpose();
  };
  for (std::size_t i = first_at_or_after(centre_m - half_width_m);
       i < size_ && point(i).s_m < centre_m + half_width_m; ++i)
    include(point(i).s_m, point(i).at_m);
  const double lead_end_m = std::min(first_m() - kSpacing_m, centre_m + half_width_m);
  const double lead_m = lead_end_m - (centre_m - half_width_m);
  for (int i = 0; i * kSpacing_m < lead_m; ++i) {
    const double s = lead_end_m - i * kSpacing_m;
    include(s, origin_m + (s - first_m()) * lead_in_);
  }
  normal(2, 2) += kFlatness * normal(0, 0);
  const Eigen::Matrix<double, 3, 2> c = normal.ldlt().solve(right);

  Eigen::Vector2d at_m = origin_m + c.row(0).transpose();
  const Eigen::Vector2d slope = c.row(1).transpose() / half_width_m;
  const Eigen::Vector2d bend = 2.0 * c.row(2).transpose() / (half_width_m * half_width_m);
  const double length = std::max(slope.norm(), 1e-6);
  at_m += (s_m - centre_m) * slope / length;
  const double curvature_1_m =
      s_m > last_m() ? 0.0 : (slope.x() * bend.y() - slope.y() * bend.x()) / (length * length * length);
  return {at_m.x(), at_m.y(), std::atan2(slope.y(), slope.x()), curvature_1_m};
}

double Trail::nearest_m(double x_m, double y_m, double near_m, double half_width_m) const {
  constexpr double kLongestStep_m = 0.2;
  double s_m = near_m;
  for (int i = 0; i < 3; ++i) {
    const Place place = at(s_m, half_width_m);
    const double ahead_m =
        (x_m - place.x_m) * std::cos(place.heading_rad) + (y_m - place.y_m) * std::sin(place.heading_rad);
    s_m += std::clamp(ahead_m, -kLongestStep_m, kLongestStep_m);
  }
  return s_m;
}

}  // namespace heel
