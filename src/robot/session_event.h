// What happened on the way to and from the robot, for whoever keeps the log.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "heel/time.h"

namespace heel {

enum class SessionEventKind : std::uint8_t {
  LineOpened,
  LineLost,
  TryingBaud,  ///< value: baud
  FoundOpen,   ///< an earlier session left the robot open: closing it
  NoAnswer,    ///< value: baud
  Synchronised,
  ConfigReceived,  ///< value: watchdog, ms
  ConfigMissing,   ///< going on with the configured limits
  FirstSip,
  RateRaised,   ///< value: baud
  RateRefused,  ///< value: baud it did not follow to
  MotorsEnabled,
  EnableRepeated,  ///< value: attempt
  EnableFailed,    ///< value: attempts
  StopButton,      ///< motors off by the button, or by E-stall
  MotorsOff,       ///< motors off for another reason
  ControllerReset,
  SipSilence,  ///< value: ms without a SIP
  OdometryRebased,
  OdometrySuspect,
  BadPacket,  ///< value: id; its checksum is right, its content is not
  Closed,
};

struct SessionEvent {
  TimeNs t_ns = 0;
  SessionEventKind kind = SessionEventKind::LineOpened;
  std::int64_t value = 0;
};

/// One line for people; the value stands for itself.
const char* to_string(SessionEventKind kind);
/// Someone should look at it.
bool is_warning(SessionEventKind kind);

/// The events nobody has fetched yet; the oldest give way.
class SessionEvents {
 public:
  void push(TimeNs t_ns, SessionEventKind kind, std::int64_t value = 0) {
    if (count_ == events_.size()) {
      first_ = (first_ + 1) % events_.size();
      --count_;
      ++lost_;
    }
    events_[(first_ + count_++) % events_.size()] = {t_ns, kind, value};
  }
  bool pop(SessionEvent& event) {
    if (count_ == 0) return false;
    event = events_[first_];
    first_ = (first_ + 1) % events_.size();
    --count_;
    return true;
  }
  std::uint64_t lost() const { return lost_; }

 private:
  std::array<SessionEvent, 64> events_{};
  std::size_t first_ = 0;
  std::size_t count_ = 0;
  std::uint64_t lost_ = 0;
};

}  // namespace heel
