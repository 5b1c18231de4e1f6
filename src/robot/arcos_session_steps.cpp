// The steps of the session that are due at a time, and the commands that they send.
#include <algorithm>
#include <cmath>

#include "arcos/command_codec.h"
#include "robot/arcos_session.h"
#include "robot/wire_units.h"

namespace heel {
namespace {

using arcos::CommandId;
using Kind = SessionEventKind;

constexpr TimeNs kListen_ns = 300 * kNsPerMs;  // three SIP cycles
// A robot answers SYNC0 within a few milliseconds; the echo takes 6 ms at 9600 baud, an adapter 16 ms.
constexpr TimeNs kQuickEcho_ns = 350 * kNsPerMs;
constexpr TimeNs kCloseTakes_ns = 150 * kNsPerMs;
constexpr TimeNs kOpenTimeout_ns = 3 * kNsPerS;
constexpr TimeNs kSipSilence_ns = 2 * kNsPerS;
constexpr TimeNs kEnableRetry_ns = 700 * kNsPerMs;
constexpr TimeNs kRefused_ns = 10 * kNsPerS;
constexpr int kEnableAttempts = 3;
constexpr std::uint64_t kLeastOtherBytes = 16;  // fewer may be noise of a line that is not connected
// The longest packet takes 0.27 s at 9600 baud: an incomplete packet that is older has lost bytes.
constexpr TimeNs kPartialPacket_ns = 300 * kNsPerMs;

/// A configured limit, no larger than the controller's own (0: unknown).
std::int16_t limited(int ours, int controllers_top) {
  const int limit = controllers_top > 0 ? std::min(ours, controllers_top) : ours;
  return static_cast<std::int16_t>(std::clamp(limit, 0, 32767));
}

}  // namespace

void ArcosSession::advance(TimeNs now_ns) {
  if (step_ == Step::NoLine) return;
  parser_.give_up_before(now_ns - kPartialPacket_ns,
                         [this](const arcos::Packet& packet) { on_packet(packet); });
  copy_line_counters();
  take_due_steps(now_ns);
}

std::span<const std::uint8_t> ArcosSession::send(const VelocityCommand& command, TimeNs now_ns) {
  out_.clear();
  if (step_ == Step::NoLine) return out_.bytes();
  flush_queue(now_ns);
  if (queue_.empty()) {
    if (step_ == Step::Running) motion_.send(command, now_ns, pacer_, out_);
    // Zero velocity feeds the robot's watchdog while the motors are off or about to be enabled.
    if (step_ == Step::Enabling || step_ == Step::Disabled) motion_.send_zero(now_ns, pacer_, out_);
  }
  return out_.bytes();
}

void ArcosSession::take_due_steps(TimeNs now_ns) {
  const TimeNs in_step_ns = now_ns - t_step_ns_;
  if (echo_heard_ && looks_for_robot()) return leave_rate(now_ns);
  if (looks_for_robot() && heard_.is_clear()) report_other_device(heard_, now_ns);
  switch (step_) {
    case Step::NoLine:
      return;
    case Step::Listening:
      if (in_step_ns >= kListen_ns) ask_sync(Step::Sync0, now_ns);
      return;
    case Step::Sync0:
      if (sweep_.quick() && in_step_ns >= kQuickEcho_ns) return leave_rate(now_ns);
      [[fallthrough]];
    case Step::Sync1:
    case Step::Sync2:
      if (bare_sync2_ && in_step_ns >= kQuickEcho_ns) return retry_sync(now_ns);
      if (in_step_ns >= ns_from_seconds(config_.sync_retry_s)) retry_sync(now_ns);
      return;
    case Step::Closing:
      if (in_step_ns >= kCloseTakes_ns && queue_.empty()) listen_after_close(now_ns);
      return;
    case Step::Opening:
      return finish_opening(now_ns);
    case Step::AskingRate:
      if (!rate_was_asked(now_ns)) return;
      change_rate(target_baud_);
      return enter(Step::TryingRate, now_ns);
    case Step::TryingRate:
      return try_rate(now_ns);
    case Step::LeavingRate:
      if (!rate_was_asked(now_ns)) return;
      change_rate(sweep_.good());
      return enter(Step::Opening, now_ns);
    case Step::Enabling:
      if (in_step_ns >= kEnableRetry_ns) retry_enable(now_ns);
      [[fallthrough]];
    case Step::Running:
    case Step::Disabled:
      if (now_ns - t_sip_ns_ >= kSipSilence_ns) disconnect_silent(now_ns);
      return;
    case Step::Silent:
      if (in_step_ns >= ns_from_seconds(config_.reconnect_s) && queue_.empty()) listen_after_close(now_ns);
      return;
    case Step::Refused:
      if (in_step_ns >= kRefused_ns) listen_after_close(now_ns);
      return;
  }
}

void ArcosSession::ask_sync(Step step, TimeNs now_ns, bool close_first) {
  const int attempts = attempts_;
  enter(step, now_ns);
  attempts_ = step == Step::Sync0 ? attempts + 1 : attempts;  // counted over all three steps of a baud rate
  const CommandId id = step == Step::Sync0   ? CommandId::Sync0
                       : step == Step::Sync1 ? CommandId::Sync1
                                             : CommandId::Sync2;
  queue_.clear();
  bare_sync2_ = false;
  // If only the last echo was lost, the robot is open, takes SYNC0 as PULSE and does not answer: it is closed
  // first. CLOSE has an argument, so that the robot cannot take it as SYNC2.
  if (close_first) queue_.push(arcos::encode_integer(CommandId::Close, 1));
  queue_.push(arcos::encode_plain(id));
}

void ArcosSession::retry_sync(TimeNs now_ns) {
  if (attempts_ < kSyncAttemptsPerBaud) {
    ask_sync(Step::Sync0, now_ns, true);
    return;
  }
  leave_rate(now_ns);
}

/// No robot has this rate: on to the next one. After the last one the sweep is over, and a person is told.
void ArcosSession::leave_rate(TimeNs now_ns) {
  if (!heard_.text().empty()) text_of_sweep_ = heard_;
  bytes_of_sweep_ += heard_.bytes();
  echo_of_sweep_ = echo_of_sweep_ || echo_heard_;
  echo_heard_ = false;
  const int before = sweep_.current();
  if (!sweep_.advance()) {
    line_exhausted_ = true;
    state_.kind = RobotKind{};
    const bool echoed = sweep_echoed();
    if (echoed) {
      report_echo(now_ns);
    } else if (!text_of_sweep_.text().empty()) {
      report_other_device(text_of_sweep_, now_ns);
    } else if (bytes_of_sweep_ >= kLeastOtherBytes) {
      say_rarely(Kind::OtherBytes, now_ns, static_cast<std::int64_t>(bytes_of_sweep_));
    } else {
      say_rarely(sweep_.sweeps() ? Kind::NoAnswer : Kind::NoAnswerTcp, now_ns);
    }
    reported_echo_ = echoed;
    text_of_sweep_.clear();
    echo_of_sweep_ = false;
    bytes_of_sweep_ = 0;
  }
  if (sweep_.current() != before) {
    if (!repeats_.is_said() && !reported_echo_) events_.push(now_ns, Kind::TryingBaud, sweep_.current());
    change_rate(sweep_.current());
  }
  heard_.clear();
  enter(Step::Listening, now_ns);
}

/// The robot was sent CLOSE, after which its port may have another rate.
void ArcosSession::listen_after_close(TimeNs now_ns) {
  const int before = sweep_.current();
  sweep_.restart_after_close();
  if (sweep_.current() != before) change_rate(sweep_.current());
  enter(Step::Listening, now_ns);
}

void ArcosSession::finish_opening(TimeNs now_ns) {
  const TimeNs in_step_ns = now_ns - t_step_ns_;
  if (!sip_seen_ || t_sip_ns_ < t_step_ns_) {  // no SIP yet at this rate
    if (in_step_ns >= kOpenTimeout_ns) disconnect_silent(now_ns);
    return;
  }
  const bool waited = in_step_ns >= ns_from_seconds(config_.config_wait_s);
  if (config_.request_config && !config_seen_ && !waited) return;
  if (config_.request_config && !config_seen_) events_.push(now_ns, Kind::ConfigMissing);
  state_.limits = limits_in_force();
  const auto deceleration_mm_s2 =
      static_cast<std::int64_t>(std::lround(state_.limits.deceleration_m_s2 * 1e3));
  if (state_.limits.known && deceleration_mm_s2 < config_.deceleration_mm_s2)
    events_.push(now_ns, Kind::BrakesLimited, deceleration_mm_s2);
  if (rate_can_rise()) return ask_rate(Step::AskingRate, target_baud_, now_ns);
  queue_limits();
  if (hold_disabled_) {
    enter(Step::Disabled, now_ns);
  } else {
    queue_enable();
    enter(Step::Enabling, now_ns);
  }
}

void ArcosSession::retry_enable(TimeNs now_ns) {
  ++attempts_;
  t_step_ns_ = now_ns;
  if (attempts_ >= kEnableAttempts) {
    events_.push(now_ns, Kind::EnableFailed, attempts_);
    hold_disabled_ = true;
    enter(Step::Disabled, now_ns);
    return;
  }
  events_.push(now_ns, Kind::EnableRepeated, attempts_ + 1);
  queue_enable();
}

void ArcosSession::enable_motors_again(TimeNs now_ns) {
  if (!hold_disabled_) return;
  hold_disabled_ = false;
  if (step_ != Step::Disabled) return;  // the next connection enables them
  events_.push(now_ns, Kind::EnableAgain);
  queue_enable();
  enter(Step::Enabling, now_ns);
  ends_e_stall_ = true;
}

void ArcosSession::disconnect_silent(TimeNs now_ns) {
  const TimeNs last_ns = sip_seen_ ? t_sip_ns_ : t_step_ns_;
  events_.push(now_ns, Kind::SipSilence, (now_ns - last_ns) / kNsPerMs);
  odometry_.interrupted();
  // The robot may still receive commands: it must stop and close its session.
  queue_.clear();
  queue_.push(arcos::encode_plain(CommandId::Stop));
  queue_.push(arcos::encode_plain(CommandId::Close));
  enter(Step::Silent, now_ns);
}

/// The smaller of what is asked for and of what CONFIGpac allows; without CONFIGpac, of what every controller
/// allows.
DriveLimits ArcosSession::limits_in_force() const {
  DriveLimits limits;
  limits.known = config_seen_ && controller_.trans_acc_top > 0;
  const DriveLimits of_factory;
  const double top_m_s2 = controller_.trans_acc_top * wire::kMetresPerMm;
  limits.acceleration_m_s2 = std::min(config_.acceleration_mm_s2 * wire::kMetresPerMm,
                                      limits.known ? top_m_s2 : of_factory.acceleration_m_s2);
  limits.deceleration_m_s2 = std::min(config_.deceleration_mm_s2 * wire::kMetresPerMm,
                                      limits.known ? top_m_s2 : of_factory.deceleration_m_s2);
  return limits;
}

void ArcosSession::queue_limits() {
  const auto push = [this](CommandId id, std::int16_t value) {
    queue_.push(arcos::encode_integer(id, value));
  };
  const auto negative = [](std::int16_t value) { return static_cast<std::int16_t>(-value); };
  push(CommandId::SetV, limited(v_limit_mm_s(), controller_.trans_vel_top));
  push(CommandId::SetA, limited(config_.acceleration_mm_s2, controller_.trans_acc_top));
  push(CommandId::SetA, negative(limited(config_.deceleration_mm_s2, controller_.trans_acc_top)));
  push(CommandId::SetRv, limited(yaw_rate_limit_deg_s(), controller_.rot_vel_top));
  push(CommandId::SetRa, limited(config_.yaw_acceleration_deg_s2, controller_.rot_acc_top));
  push(CommandId::SetRa, negative(limited(config_.yaw_acceleration_deg_s2, controller_.rot_acc_top)));
  push(CommandId::Sonar, config_.sonar ? 1 : 0);
}

void ArcosSession::queue_enable() {
  // Zero velocity before the motors are enabled: an old set point must not become active.
  queue_.push(arcos::encode_integer(CommandId::Vel, 0));
  queue_.push(arcos::encode_integer(CommandId::RVel, 0));
  queue_.push(arcos::encode_integer(CommandId::Enable, 1));
  motion_.begin_with_zero();
}

void ArcosSession::flush_queue(TimeNs now_ns) {
  while (!queue_.empty() && pacer_.may_send(now_ns)) {
    out_.append(queue_.front());
    pacer_.sent(queue_.front().size(), now_ns);
    queue_.pop();
  }
}

}  // namespace heel
