// The table of conditions, every combination of them.
#include "control/condition_table.h"

#include <gtest/gtest.h>

#include <set>

#include "control/supervisor_oracle.h"

namespace heel {
namespace {

TEST(ConditionTable, EveryConditionAndEveryReasonHasExactlyOneRow) {
  Conditions seen = 0;
  std::set<StopReason> reasons;
  for (const ConditionRow& row : kConditionTable) {
    EXPECT_EQ(seen & row.condition, 0U);
    seen |= row.condition;
    EXPECT_TRUE(reasons.insert(row.reason).second);
    EXPECT_NE(row.reason, StopReason::None);
    // A cause has the name of its reason; two rows about the target have one cause.
    EXPECT_STREQ(to_string(row.cause),
                 to_string(row.reason == StopReason::NoTargetYet ? StopReason::TargetLost : row.reason));
  }
  EXPECT_EQ(seen, kAllConditions);
  EXPECT_EQ(reasons.size(), static_cast<std::size_t>(StopReason::TurnsAway));
}

TEST(ConditionTable, TheKindsAreThoseOfTheRules) {
  EXPECT_EQ(kFaults, test::kFaultBits);
  EXPECT_EQ(kSensesMissing, test::kSensesBits);
  EXPECT_EQ(kTargetMissing, Conditions{kTargetLost | kNoTargetYet});
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
  if (c & kTurnsAway) return StopReason::TurnsAway;
  if (c & kOperatorAway) return StopReason::OperatorAway;
  if (c & kSonarSilent) return StopReason::SonarSilent;
  if (c & kStaleFrame) return StopReason::StaleFrame;
  if (c & kAmbiguous) return StopReason::Ambiguous;
  if (c & kLowCertainty) return StopReason::LowCertainty;
  if (c & kTargetLost) return StopReason::TargetLost;
  if (c & kNoTargetYet) return StopReason::NoTargetYet;
  return StopReason::None;
}

TEST(ConditionTable, EveryCombinationGivesTheFirstReason) {
  for (Conditions conditions = 0; conditions <= kAllConditions; ++conditions) {
    const ConditionRow* const first = first_condition(conditions);
    ASSERT_EQ(first != nullptr ? first->reason : StopReason::None, expected_reason(conditions)) << conditions;
  }
}

}  // namespace
}  // namespace heel
