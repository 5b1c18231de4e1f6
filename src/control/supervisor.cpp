#include "control/supervisor.h"

namespace heel {
namespace {

// The order: shutdown; no knowledge of the robot; motors off; contact; missing sensor data. The rows about
// the target go from the most to the least specific.
constexpr SupervisorRow kTable[] = {
    {kShutdown, StopReason::Shutdown, StopStyle::AtOnce},
    {kLinkDown, StopReason::LinkDown, StopStyle::AtOnce},
    {kStaleSip, StopReason::StaleSip, StopStyle::AtOnce},
    {kStopButton, StopReason::StopButton, StopStyle::AtOnce},
    {kMotorsOff, StopReason::MotorsOff, StopStyle::AtOnce},
    {kBumper, StopReason::Bumper, StopStyle::AtOnce},
    {kStall, StopReason::Stall, StopStyle::AtOnce},
    {kOverrun, StopReason::Overrun, StopStyle::AtOnce},
    {kClockStep, StopReason::ClockStep, StopStyle::AtOnce},
    {kBatteryLow, StopReason::BatteryLow, StopStyle::AtOnce},
    {kOperatorAway, StopReason::OperatorAway, StopStyle::AtOnce},
    {kSonarSilent, StopReason::SonarSilent, StopStyle::ComeToRest},
    {kStaleFrame, StopReason::StaleFrame, StopStyle::ComeToRest},
    {kAmbiguous, StopReason::Ambiguous, StopStyle::ComeToRest},
    {kLowCertainty, StopReason::LowCertainty, StopStyle::ComeToRest},
    {kTargetLost, StopReason::TargetLost, StopStyle::ComeToRest},
    {kNoTargetYet, StopReason::NoTargetYet, StopStyle::ComeToRest},
};

}  // namespace

std::span<const SupervisorRow> supervisor_table() {
  return kTable;
}

Verdict supervise(Conditions conditions) {
  for (const auto& row : kTable) {
    if (conditions & row.condition) return {row.reason, row.style};
  }
  return {};
}

}  // namespace heel
