// Events of the session with the robot, for the log.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "heel/time.h"

namespace heel {

enum class SessionEventKind : std::uint8_t {
  LineOpened,
  LineLost,
  LineEnded,     ///< before a robot answered
  TryingBaud,    ///< value: baud
  FoundOpen,     ///< an earlier session has left the robot open: it is closed
  NoAnswer,      ///< at any rate
  NoAnswerTcp,   ///< over TCP, where the rate is not ours
  OtherDevice,   ///< text comes, and nothing in ARCOS
  LineEchoes,    ///< what heeld sends comes back
  OtherBytes,    ///< value: how many come in a sweep, no text and nothing in ARCOS
  Synchronised,  ///< the robot has said what it is, and may be driven
  ModelUnknown,  ///< it is refused; ModelChoice says why
  ModelConflict,
  ModelMissing,
  ConfigReceived,  ///< value: watchdog, ms
  ConfigMissing,   ///< the limits of the factory are assumed
  BrakesLimited,   ///< value: mm/s²; CONFIGpac allows less than is asked for
  FirstSip,
  RateRaised,   ///< value: baud
  RateRefused,  ///< value: the baud rate that the robot did not change to
  MotorsEnabled,
  EnableRepeated,  ///< value: attempt
  EnableFailed,    ///< value: attempts
  EnableAgain,     ///< by an operator's reset
  StopButton,      ///< motors off by the button, or by E-stall
  MotorsOff,       ///< motors off for another reason
  ControllerReset,
  SipSilence,  ///< value: ms without a SIP
  OdometryRebased,
  OdometrySuspect,
  BadPacket,  ///< value: id; its checksum is right, its layout is wrong
  Closed,
};

struct SessionEvent {
  TimeNs t_ns = 0;
  SessionEventKind kind = SessionEventKind::LineOpened;
  std::int64_t value = 0;
};

/// One line for people, with "{}" in place of the value and, of the robot, "{class}", "{subclass}" and
/// "{model}", of another device "{text}".
const char* to_string(SessionEventKind kind);
/// True for events that a person should know about.
bool is_warning(SessionEventKind kind);

/// The events that have not been popped yet. When it is full, the oldest is dropped.
class SessionEvents {
 public:
  void push(TimeNs t_ns, SessionEventKind kind, std::int64_t value = 0) {
    if (count_ == events_.size()) {
      first_ = (first_ + 1) % events_.size();
      --count_;
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

 private:
  std::array<SessionEvent, 64> events_{};
  std::size_t first_ = 0;
  std::size_t count_ = 0;
};

}  // namespace heel
