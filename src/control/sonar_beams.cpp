#include "control/sonar_beams.h"

#include <algorithm>
#include <cmath>

namespace heel {
namespace {

constexpr double kHalfBeam_rad = 0.27;   // an echo is from within this angle of the middle of the beam
constexpr double kHalfHeard_rad = 0.21;  // what is within this angle is heard for certain
constexpr double kRangeMargin_m = 0.12;  // odometry, and what a person's legs and clothes do to a range
constexpr double kJudged_m = 2.5;        // echoes farther away are not judged
constexpr TimeNs kOldest_ns = kNsPerS;   // odometry is good for so long
constexpr int kArcParts = 12;

double part_rad(const SonarBeam& beam, int part) {
  return beam.sonar.heading_rad + kHalfBeam_rad * (2.0 * part / kArcParts - 1.0);
}

bool is_free_in(const SonarBeam& earlier, double x_m, double y_m) {
  const double dx_m = x_m - earlier.sonar.x_m, dy_m = y_m - earlier.sonar.y_m;
  const double c = std::cos(earlier.sonar.heading_rad), s = std::sin(earlier.sonar.heading_rad);
  const double ahead_m = c * dx_m + s * dy_m, beside_m = c * dy_m - s * dx_m;
  return std::hypot(dx_m, dy_m) < earlier.range_m - kRangeMargin_m &&
         std::abs(beside_m) < std::tan(kHalfHeard_rad) * ahead_m;
}

}  // namespace

void SonarBeams::add(const SonarBeam& beam) {
  ring_[next_] = beam;
  next_ = (next_ + 1) % kCapacity;
  size_ = std::min(size_ + 1, kCapacity);
}

bool SonarBeams::heard_free(const SonarBeam& beam, double heading_rad) const {
  const double x_m = beam.sonar.x_m + beam.range_m * std::cos(heading_rad);
  const double y_m = beam.sonar.y_m + beam.range_m * std::sin(heading_rad);
  return std::any_of(ring_.begin(), ring_.begin() + static_cast<std::ptrdiff_t>(size_),
                     [&](const SonarBeam& earlier) {
                       return beam.t_ns - earlier.t_ns <= kOldest_ns && is_free_in(earlier, x_m, y_m);
                     });
}

bool SonarBeams::has_come(const SonarBeam& beam) const {
  if (!(beam.range_m < kJudged_m)) return false;
  for (int part = 0; part <= kArcParts; ++part)
    if (!heard_free(beam, part_rad(beam, part))) return false;
  return true;
}

}  // namespace heel
