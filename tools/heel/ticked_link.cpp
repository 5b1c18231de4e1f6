#include "ticked_link.h"

#include <array>

#include "realtime/clock.h"
#include "robot/session_event_text.h"

namespace heel::cli {
namespace {

constexpr TimeNs kTick_ns = kNsPerS / 50;
constexpr TimeNs kConnect_ns = 20 * kNsPerS;  // a sweep of all rates takes 9 s
constexpr std::uint64_t kMostOpenFailures = 2;
constexpr TimeNs kExpiry_ns = 250 * kNsPerMs;

}  // namespace

TickedLink::~TickedLink() {
  link_.shutdown(monotonic_now_ns());
}

bool TickedLink::run(double v_m_s, double yaw_rate_rad_s, TimeNs longest_ns,
                     const std::function<bool()>& done) {
  VelocityCommand command;
  command.v_m_s = v_m_s;
  command.yaw_rate_rad_s = yaw_rate_rad_s;
  const TimeNs end_ns = monotonic_now_ns() + longest_ns;
  for (TimeNs next_ns = monotonic_now_ns(); next_ns < end_ns && !g_preflight_interrupted;) {
    next_ns += kTick_ns;
    link_.receive_until(next_ns);
    const TimeNs now_ns = monotonic_now_ns();
    link_.read(now_ns);
    command.t_issued_ns = now_ns;
    command.t_expires_ns = now_ns + kExpiry_ns;
    link_.write(command, now_ns);
    note_events();
    if (done()) return true;
  }
  return false;
}

bool TickedLink::connect() {
  return run(0.0, 0.0, kConnect_ns,
             [&] {
               return state().phase == LinkPhase::Running || state().phase == LinkPhase::Disabled ||
                      state().phase == LinkPhase::Refused || link_.open_failures() > kMostOpenFailures;
             }) &&
         link_.open_failures() <= kMostOpenFailures;
}

std::string TickedLink::last_note() const {
  return link_.open_failures() > 0 && note_.empty() ? link_.last_open_error() : note_;
}

void TickedLink::note_events() {
  SessionEvent event;
  while (link_.next_event(event)) {
    std::array<char, 400> text{};
    write_event_text(event, state().kind, link_.heard_text(), text);
    std::string line = text.data();
    if (const std::size_t place = line.find("{}"); place != std::string::npos)
      line.replace(place, 2, std::to_string(event.value));
    if (event.kind == SessionEventKind::Synchronised) kind_ = line.substr(line.find(": ") + 2);
    if (is_warning(event.kind)) note_ = line;
  }
}

bool require_running(TickedLink& link, const RobotConfig& config, PreflightStep& step) {
  const bool answered = link.connect();
  const std::string note = link.last_note();
  if (!answered) {
    step.fail(note.empty() ? config.address + ": robot does not answer" : note, advice_on(note, kNoRobot));
    return false;
  }
  if (link.state().phase == LinkPhase::Refused) {
    step.fail(note, "docs/hardware.md lists the robots that heel knows");
    return false;
  }
  if (link.state().phase == LinkPhase::Disabled) {
    step.fail(note, "release the stop button and charge the battery");
    return false;
  }
  return true;
}

}  // namespace heel::cli
