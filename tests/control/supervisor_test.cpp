// The supervisor's table, every combination of conditions.
#include "control/supervisor.h"

#include <gtest/gtest.h>

#include <set>

namespace heel {
namespace {

TEST(Supervisor, FollowsWhenNothingHolds) {
  EXPECT_EQ(supervise(0).reason, StopReason::None);
  EXPECT_EQ(supervise(0).style, StopStyle::Go);
}

TEST(Supervisor, EveryConditionAndEveryReasonHasExactlyOneRow) {
  Conditions seen = 0;
  std::set<StopReason> reasons;
  for (const auto& row : supervisor_table()) {
    EXPECT_EQ(seen & row.condition, 0U);
    seen |= row.condition;
    EXPECT_TRUE(reasons.insert(row.reason).second);
    EXPECT_NE(row.reason, StopReason::None);
    EXPECT_NE(row.style, StopStyle::Go);
  }
  EXPECT_EQ(seen, kAllConditions);
  EXPECT_EQ(reasons.size(), static_cast<std::size_t>(StopReason::OperatorAway));
}

/// The order of the reasons, written here again and not taken from the table.
StopReason expected_reason(unsigned c) {
  if (c & kShutdown) return StopReason::Shutdown;
  if (c & kLinkDown) return StopReason::LinkDown;
  if (c & kStaleSip) return StopReason::StaleSip;
  if (c & kStopButton) return StopReason::StopButton;
  if (c & kMotorsOff) return StopReason::MotorsOff;
  if (c & kBumper) return StopReason::Bumper;
  if (c & kStall) return StopReason::Stall;
  if (c & kOverrun) return StopReason::Overrun;
  if (c & kClockStep) return StopReason::ClockStep;
  if (c & kBatteryLow) return StopReason::BatteryLow;
  if (c & kOperatorAway) return StopReason::OperatorAway;
  if (c & kSonarSilent) return StopReason::SonarSilent;
  if (c & kStaleFrame) return StopReason::StaleFrame;
  if (c & kAmbiguous) return StopReason::Ambiguous;
  if (c & kLowCertainty) return StopReason::LowCertainty;
  if (c & kTargetLost) return StopReason::TargetLost;
  if (c & kNoTargetYet) return StopReason::NoTargetYet;
  return StopReason::None;
}

TEST(Supervisor, EveryCombinationGivesTheFirstReasonAndItsStyle) {
  for (unsigned conditions = 0; conditions <= kAllConditions; ++conditions) {
    const Verdict verdict = supervise(conditions);
    ASSERT_EQ(verdict.reason, expected_reason(conditions)) << conditions;
    const bool only_sensor_conditions =
        (conditions & ~unsigned{kSonarSilent | kStaleFrame | kAmbiguous | kLowCertainty | kTargetLost |
                                kNoTargetYet}) == 0;
    const StopStyle style = conditions == 0          ? StopStyle::Go
                            : only_sensor_conditions ? StopStyle::ComeToRest
                                                     : StopStyle::AtOnce;
    ASSERT_EQ(verdict.style, style) << conditions;
  }
}

}  // namespace
}  // namespace heel
