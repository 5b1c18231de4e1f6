// Whether a new echo is from something that has come since the earlier readings.
#include "control/sonar_beams.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace heel {
namespace {

constexpr TimeNs kNow_ns = 10 * kNsPerS;
constexpr TimeNs kSweep_ns = 320 * kNsPerMs;

SonarBeam beam(double heading_rad, double range_m, TimeNs t_ns, double x_m = 0.0) {
  return {t_ns, {x_m, 0.0, heading_rad}, range_m};
}

/// Sonars 1 to 5 at one place, 0.35 rad apart, heard `range_m` one sweep ago.
SonarBeams heard(double range_m, TimeNs age_ns = kSweep_ns) {
  SonarBeams beams;
  for (std::size_t number = 1; number <= 5; ++number)
    beams.add(beam(0.35 * (static_cast<double>(number) - 3.0), range_m, kNow_ns - age_ns));
  return beams;
}

TEST(SonarBeams, WhatIsHeardWhereItWasFreeHasCome) {
  EXPECT_TRUE(heard(5.0).has_come(beam(0.0, 1.0, kNow_ns)));
  EXPECT_TRUE(heard(1.3).has_come(beam(0.0, 1.0, kNow_ns)));
}

TEST(SonarBeams, WhatMayHaveBeenThereHasNot) {
  EXPECT_FALSE(SonarBeams().has_come(beam(0.0, 1.0, kNow_ns))) << "nothing was heard before";
  EXPECT_FALSE(heard(1.05).has_come(beam(0.0, 1.0, kNow_ns))) << "the noise of a range";
  EXPECT_FALSE(heard(0.8).has_come(beam(0.0, 1.0, kNow_ns))) << "something nearer was before it";
  EXPECT_FALSE(heard(5.0).has_come(beam(0.7, 1.0, kNow_ns))) << "no beam was where its outer part is";
  EXPECT_FALSE(heard(5.0, 2 * kNsPerS).has_come(beam(0.0, 1.0, kNow_ns))) << "that was long ago";
  EXPECT_FALSE(heard(5.0).has_come(beam(0.0, 3.0, kNow_ns))) << "far away";
}

TEST(SonarBeams, WhatWasHeardBeforeItWasClearedDoesNotCount) {
  SonarBeams beams = heard(5.0);
  beams.clear();
  EXPECT_FALSE(beams.has_come(beam(0.0, 1.0, kNow_ns)));
  for (std::size_t number = 1; number <= 5; ++number)
    beams.add(beam(0.35 * (static_cast<double>(number) - 3.0), 1.0, kNow_ns - kSweep_ns));
  EXPECT_FALSE(beams.has_come(beam(0.0, 1.0, kNow_ns))) << "it was there in every beam since";
  beams.clear();
  for (std::size_t number = 1; number <= 5; ++number)
    beams.add(beam(0.35 * (static_cast<double>(number) - 3.0), 5.0, kNow_ns - kSweep_ns));
  EXPECT_TRUE(beams.has_come(beam(0.0, 1.0, kNow_ns)));
}

TEST(SonarBeams, AWallThatTheRobotApproachesHasNotCome) {
  SonarBeams beams;
  for (double x_m = 0.0; x_m < 2.0; x_m += 0.02) {
    const auto number = static_cast<std::size_t>(x_m / 0.02) % 5 + 1;
    const double heading_rad = 0.35 * (static_cast<double>(number) - 3.0);
    // The wall is at x = 3 m: its nearest part in a beam is at the beam's inner edge.
    const double inner_rad = std::max(0.0, std::abs(heading_rad) - 0.26);
    const SonarBeam now =
        beam(heading_rad, (3.0 - x_m) / std::cos(inner_rad), kNow_ns + ns_from_seconds(x_m / 0.5), x_m);
    EXPECT_FALSE(beams.has_come(now)) << x_m;
    beams.add(now);
  }
}

}  // namespace
}  // namespace heel
