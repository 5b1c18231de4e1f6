#include "estimate/odometry_history.h"

#include <cmath>

namespace heel {

Pose2 extrapolated(const Odometry& from, double dt_s) {
  const double turn_rad = from.yaw_rate_rad_s * dt_s;
  const double half = 0.5 * turn_rad;
  const double sinc = std::abs(half) < 1e-6 ? 1.0 : std::sin(half) / half;
  const double chord_m = from.v_m_s * dt_s * sinc;
  return {from.x_m + chord_m * std::cos(from.heading_rad + half),
          from.y_m + chord_m * std::sin(from.heading_rad + half), from.heading_rad + turn_rad};
}

namespace {

Pose2 interpolated(const Odometry& a, const Odometry& b, TimeNs t_ns) {
  const double s = static_cast<double>(t_ns - a.t_ns) / static_cast<double>(b.t_ns - a.t_ns);
  return {a.x_m + s * (b.x_m - a.x_m), a.y_m + s * (b.y_m - a.y_m),
          a.heading_rad + s * (b.heading_rad - a.heading_rad)};
}

}  // namespace

void OdometryHistory::add(const Odometry& odometry) {
  if (size_ > 0 && odometry.t_ns <= from_newest(0).t_ns) return;
  ring_[next_] = odometry;
  next_ = (next_ + 1) % kCapacity;
  if (size_ < kCapacity) ++size_;
}

std::optional<Pose2> OdometryHistory::pose_at(TimeNs t_ns) const {
  if (size_ == 0) return std::nullopt;
  const Odometry& newest = from_newest(0);
  if (t_ns >= newest.t_ns) {
    if (t_ns - newest.t_ns > kMaxAhead_ns) return std::nullopt;
    return extrapolated(newest, seconds_from_ns(t_ns - newest.t_ns));
  }
  for (std::size_t back = 1; back < size_; ++back) {
    const Odometry& older = from_newest(back);
    if (older.t_ns <= t_ns) return interpolated(older, from_newest(back - 1), t_ns);
  }
  return std::nullopt;
}

}  // namespace heel
