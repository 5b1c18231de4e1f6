// The session with the robot's controller, from the first SYNC0 to the last CLOSE. Its inputs are bytes and
// the time, its output is bytes: it uses no device and no clock, so that the daemon and the lock-step
// simulator run the same code. It does not allocate after construction.
//
//   NoLine → Listening → Sync0 → Sync1 → Sync2 (→ Refused → Listening) → Opening → Enabling → Running →
//   Disabled (reset: → Enabling)
//              ↑  └ a SIP: left open → Closing ┘      ⇅          └ silence, reset → Silent → Listening
//                                            AskingRate → TryingRate (→ LeavingRate): a faster line
//
// Listening comes first because a robot that was left open takes SYNC0 as PULSE, and a pulse may resume its
// motion.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string_view>

#include "arcos/config_packet.h"
#include "arcos/other_packets.h"
#include "arcos/parser.h"
#include "arcos/sip.h"
#include "core/config.h"
#include "core/robot_model.h"
#include "heel/flow.h"
#include "robot/baud_sweep.h"
#include "robot/command_pacer.h"
#include "robot/heard_text.h"
#include "robot/motion_sender.h"
#include "robot/odometry.h"
#include "robot/outgoing.h"
#include "robot/repeats.h"
#include "robot/session_event.h"

namespace heel {

class ArcosSession {
 public:
  /// Throws heel::Error when the address cannot be understood.
  explicit ArcosSession(const RobotConfig& config);

  void line_opened(TimeNs now_ns);
  void line_lost(TimeNs now_ns);

  /// Bytes from the line; `t_ns` is when they came.
  void receive(std::span<const std::uint8_t> bytes, TimeNs t_ns);

  /// Once a tick, after the line has been read: takes the steps that are due at `now_ns`. state() is then
  /// what this tick decides on.
  void advance(TimeNs now_ns);

  /// Once a tick, after advance(): what is to be written now, valid until the next call. Leaves state() as it
  /// is.
  std::span<const std::uint8_t> send(const VelocityCommand& command, TimeNs now_ns);

  /// The rate that the line must have. It changes when no robot is found at a rate, and when the robot has
  /// been asked for another one. After a change advance() and send() are to be called again only when the
  /// line runs at it.
  int wanted_baud() const { return sweep_.current(); }
  /// True: every rate was tried without an answer; opening the device again may help.
  bool line_exhausted() const { return line_exhausted_; }

  /// An operator's reset: the motors that went off, or were not enabled, may be enabled again; nothing
  /// otherwise. To be called between advance() and send().
  void enable_motors_again(TimeNs now_ns);

  /// STOP, SONAR 0, CLOSE, to be sent whenever the program ends. Nothing more is sent until line_opened().
  std::span<const std::uint8_t> close(TimeNs now_ns);

  const RobotState& state() const { return state_; }
  const arcos::RobotIdentity& identity() const { return identity_; }
  /// The text of the last OtherDevice.
  std::string_view heard_text() const { return reported_text_.text(); }
  bool next_event(SessionEvent& event) { return events_.pop(event); }

 private:
  enum class Step : std::uint8_t {
    NoLine,
    Listening,  ///< waits whether the robot already sends packets
    Sync0,
    Sync1,
    Sync2,
    Closing,      ///< the robot was left open: CLOSE has been sent and takes effect
    Opening,      ///< OPEN sent; waits for a SIP and the configuration
    AskingRate,   ///< HOSTBAUD sent at the old rate
    TryingRate,   ///< waits for a packet at the new rate
    LeavingRate,  ///< no packet: HOSTBAUD sent at the new rate, to return to the old one
    Enabling,
    Running,
    Disabled,
    Silent,   ///< SIPs stopped: a pause, then Listening
    Refused,  ///< not a robot that may be driven: a pause, then Listening, perhaps to another one
  };

  void enter(Step step, TimeNs now_ns);
  void set_phase(LinkPhase phase);
  bool is_connected() const;
  void copy_line_counters();

  void on_packet(const arcos::Packet& packet);
  void on_sync_echo(std::uint8_t number, const arcos::Packet& packet);
  void on_sip(const arcos::Packet& packet);
  void on_config(const arcos::Packet& packet);
  void on_reset_notice(TimeNs t_ns);
  void apply_motor_flags(TimeNs t_ns);
  void close_earlier_session(TimeNs t_ns);

  void take_due_steps(TimeNs now_ns);
  void retry_sync(TimeNs now_ns);
  void leave_rate(TimeNs now_ns);
  void report_other_device(const HeardText& heard, TimeNs now_ns);
  void say_rarely(SessionEventKind trouble, TimeNs now_ns, std::int64_t value = 0);
  void robot_answered();
  void listen_after_close(TimeNs now_ns);
  void finish_opening(TimeNs now_ns);
  void retry_enable(TimeNs now_ns);
  void disconnect_silent(TimeNs now_ns);

  // arcos_session_model.cpp
  void on_identity(const arcos::RobotIdentity& identity, TimeNs t_ns);
  void use_model(const RobotModel& model);
  void open_robot(TimeNs t_ns);
  int v_limit_mm_s() const { return std::min(config_.v_limit_mm_s, model_->v_max_mm_s); }
  int yaw_rate_limit_deg_s() const {
    return std::min(config_.yaw_rate_limit_deg_s, model_->yaw_rate_max_deg_s);
  }

  // arcos_session_echo.cpp
  bool is_echo(const arcos::Packet& packet) const;
  void on_echo();
  bool looks_for_robot() const;
  bool may_be_echo_of_sync2(const arcos::Packet& packet) const;
  bool sweep_echoed() const;
  void report_echo(TimeNs now_ns);

  // arcos_session_rate.cpp
  bool rate_can_rise() const;
  void ask_rate(Step step, int baud, TimeNs now_ns);
  bool rate_was_asked(TimeNs now_ns) const;
  void change_rate(int baud);
  void try_rate(TimeNs now_ns);
  void rate_confirmed(TimeNs t_ns);

  void ask_sync(Step step, TimeNs now_ns, bool close_first = false);
  DriveLimits limits_in_force() const;
  void queue_limits();
  void queue_enable();
  void flush_queue(TimeNs now_ns);

  static constexpr int kSyncAttemptsPerBaud = 2;

  RobotConfig config_;
  BaudSweep sweep_;
  int target_baud_;  ///< the rate in the address
  CommandPacer pacer_;
  const RobotModel* model_;  ///< in robot_models(): of the robot that answered last
  MotionSender motion_;
  OdometryTracker odometry_;
  arcos::Parser parser_;
  FrameQueue queue_;
  OutgoingBytes out_;
  SessionEvents events_;
  HeardText heard_;          ///< at this rate
  HeardText text_of_sweep_;  ///< at any rate of the sweep
  std::uint64_t bytes_of_sweep_ = 0;
  HeardText reported_text_;     ///< of the last OtherDevice since a robot answered
  Repeats repeats_;             ///< of what keeps a robot from answering
  bool answered_ = false;       ///< a robot did, since the line was opened
  bool bare_sync2_ = false;     ///< SYNC2 came back as it was sent
  bool echo_heard_ = false;     ///< at this rate
  bool echo_of_sweep_ = false;  ///< what heeld sent came back
  bool reported_echo_ = false;  ///< since a robot answered
  RobotState state_;
  arcos::RobotIdentity identity_;

  // Members, because they are too large to be copied on the stack of a real-time thread.
  arcos::Sip sip_;
  arcos::ConfigPacket controller_;

  Step step_ = Step::NoLine;
  TimeNs t_step_ns_ = 0;  ///< when the step, or its last attempt, started
  TimeNs t_sip_ns_ = 0;
  int attempts_ = 0;
  bool sip_seen_ = false;     ///< since OPEN
  bool config_seen_ = false;  ///< since OPEN
  bool was_connected_ = false;
  bool line_exhausted_ = false;
  bool rate_refused_ = false;   ///< the robot is asked for a faster rate once
  bool hold_disabled_ = false;  ///< the motors went off: they are not enabled without a reset
  bool ends_e_stall_ = false;   ///< Enabling after a reset: ENABLE ends an E-stall
};

}  // namespace heel
