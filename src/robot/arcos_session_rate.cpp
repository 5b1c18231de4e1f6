// How the session makes a slow line faster before the motors are enabled. A controller that can change its
// rate (CONFIGpac: Autobaud 2) is asked for the rate in the address, and the line changes to it as well:
//
//   Opening ─HOSTBAUD→ AskingRate ─10 ms, retune→ TryingRate ─any packet→ Opening, at the new rate
//                                                     └900 ms, HOSTBAUD→ LeavingRate ─10 ms, retune→ Opening
//
// Before the line returns to the old rate, the robot is asked at the new rate to return too: it may have
// changed although no packet was received. If the robot is lost nevertheless, Opening receives nothing, and
// the sweep over all rates finds the robot.
#include <algorithm>

#include "arcos/command_codec.h"
#include "robot/arcos_session.h"

namespace heel {
namespace {

using arcos::CommandId;
using Kind = SessionEventKind;

constexpr std::uint8_t kAutobaudAutomatic = 2;
constexpr TimeNs kSettle_ns = 10 * kNsPerMs;
constexpr TimeNs kConfirm_ns = 900 * kNsPerMs;
constexpr TimeNs kPulse_ns = 200 * kNsPerMs;

arcos::Frame host_baud_command(int baud) {
  const auto at = std::find(kRobotBauds.begin(), kRobotBauds.end(), baud);
  return arcos::encode_integer(CommandId::HostBaud, static_cast<std::int16_t>(at - kRobotBauds.begin()));
}

}  // namespace

bool ArcosSession::rate_can_rise() const {
  return sweep_.sweeps() && !rate_refused_ && config_seen_ && controller_.autobaud == kAutobaudAutomatic &&
         target_baud_ > sweep_.current();
}

void ArcosSession::ask_rate(Step step, int baud, TimeNs now_ns) {
  enter(step, now_ns);
  queue_.clear();
  queue_.push(host_baud_command(baud));
}

/// True: HOSTBAUD has been sent, and the robot has had time to change its rate.
bool ArcosSession::rate_was_asked(TimeNs now_ns) const {
  return queue_.empty() && now_ns >= pacer_.idle_from_ns() + kSettle_ns;
}

void ArcosSession::try_rate(TimeNs now_ns) {
  const TimeNs in_step_ns = now_ns - t_step_ns_;
  if (in_step_ns >= kConfirm_ns) {
    rate_refused_ = true;
    events_.push(now_ns, Kind::RateRefused, sweep_.current());
    ask_rate(Step::LeavingRate, sweep_.good(), now_ns);
  } else if (in_step_ns >= kSettle_ns + attempts_ * kPulse_ns) {
    ++attempts_;
    queue_.push(arcos::encode_plain(CommandId::Pulse));
  }
}

void ArcosSession::rate_confirmed(TimeNs t_ns) {
  sweep_.found();
  events_.push(t_ns, Kind::RateRaised, sweep_.current());
  queue_.clear();
  enter(Step::Opening, t_ns);
}

void ArcosSession::change_rate(int baud) {
  sweep_.attempt(baud);
  pacer_.set_baud(baud);
  parser_.reset();
  heard_.clear();
}

}  // namespace heel
