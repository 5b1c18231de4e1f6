// A Pioneer P3-AT, or another robot of its family, behind its serial line: bytes in, bytes out, and a robot
// that moves. It has no I/O and no clock: the caller passes the time, so that the same model runs on a pty in
// real time and in the lock-step simulator.
//
//   receive(bytes, t) → line (rate, faults) → parser → session and commands → drive → wheels
//   take_output()     ← line (rate, faults) ← SIP, CONFIGpac, …              ← odometry, truth
//
// The model advances in steps of kStep_ns, so that results do not depend on how often advance() is called.
// Time begins at 0.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "arcos/command_codec.h"
#include "arcos/config_packet.h"
#include "arcos/packet.h"
#include "arcos/parser.h"
#include "arcos/sip.h"
#include "sim/robot/chassis.h"
#include "sim/robot/drive.h"
#include "sim/robot/fault.h"
#include "sim/robot/robot_event.h"
#include "sim/robot/robot_line.h"
#include "sim/robot/settings.h"
#include "sim/robot/sonar.h"
#include "sim/robot/stall_monitor.h"

namespace heel::sim {

/// The state of the connection; it determines what the packet ids 0, 1 and 2 mean.
enum class Session : std::uint8_t {
  Waiting,      ///< for SYNC0
  Synced0,      ///< SYNC0 echoed
  Synced1,      ///< SYNC1 echoed
  Connected,    ///< SYNC2 echoed: 0 PULSE, 1 OPEN, 2 CLOSE; no SIPs yet
  Open,         ///< SIPs are sent, the watchdog is active
  Maintenance,  ///< after packet 255: neither receives nor sends until a reset
};
const char* to_string(Session session);

/// The true state, which the client does not know.
struct RobotTruth {
  TimeNs t_ns = 0;
  Pose2 pose;  ///< in the world
  double v_m_s = 0.0;
  double yaw_rate_rad_s = 0.0;
  Pose2 odometry;  ///< as the firmware integrates it, unwrapped
  WheelSpeeds wheels;
  Session session = Session::Waiting;
  bool motors_enabled = false;
  bool watchdog_stopped = false;
  bool stall_left = false;
  bool stall_right = false;
  bool stop_button = false;
  std::uint8_t bumpers_front = 0;  ///< bit i: segment i
  std::uint8_t bumpers_rear = 0;
  int baud = 0;
};

class P3At {
 public:
  static constexpr TimeNs kStep_ns = kNsPerMs;

  explicit P3At(const P3AtSettings& settings, std::uint64_t seed = 1);

  // The line.
  /// Bytes that the client sends at `t_ns`; when they arrive depends on the line's rate.
  void receive(std::span<const std::uint8_t> bytes, TimeNs t_ns);
  /// Advances the model to `t_ns`, which must not be before that of the last call.
  void advance(TimeNs t_ns);
  /// The bytes that have reached the client since the last call, up to the time of the last advance().
  std::vector<std::uint8_t> take_output();
  /// The rate of the client's end; bytes at another rate than the robot's arrive as garbage. 0: always the
  /// robot's.
  void set_host_baud(int baud) { line_.set_host_baud(baud); }
  int baud() const { return line_.robot_baud(); }
  /// The client has disconnected. An open robot does not notice, and bytes on the line still arrive; an
  /// incomplete handshake is forgotten.
  void line_dropped();
  /// Number of the client's bytes that have not arrived yet. A caller that keeps the line's rate stops
  /// reading when it grows.
  std::size_t input_backlog() const { return line_.input_backlog(); }

  // The world.
  const RobotModel& model() const { return settings_.model; }
  const Pose2& true_pose() const { return chassis_.true_pose(); }
  RobotTruth truth() const;
  void place(const Pose2& pose) { chassis_.place(pose); }
  void set_true_track(double track_m) { chassis_.set_true_track(track_m); }
  void set_range_finder(RangeFinder range_m) { sonar_.set_range_finder(std::move(range_m)); }
  /// Sets the pressed bumper segments, bit i for segment i.
  void touch_bumper(std::uint8_t front, std::uint8_t rear);
  void press_stop_button(bool pressed) { button_pressed_ = pressed; }
  /// Blocks wheels: driving them then ends in a stall.
  void block_wheels(bool left, bool right);
  void inject(const Fault& fault) { faults_.add(fault); }
  /// Restarts the controller at its boot rate with notice `notice_id`, FE or FF. Odometry and state are lost.
  void reset(std::uint8_t notice_id = 0xFE);

  std::vector<RobotEvent> take_events();

 private:
  /// Packets sent on request, once or with every SIP.
  enum class Request : std::uint8_t { No, Once, Stream };

  // p3at.cpp: the parts of one step
  void step();
  void begin_fault(const Fault& fault);
  void read_switches();
  void read_line();
  void check_watchdog();
  void turn_wheels();
  void send_due_packets();
  Drive::Progress progress() const;
  bool pushes_against_bumper() const;
  bool stalled() const;
  void log(RobotEventKind kind, int value = 0) { events_.push_back({t_ns_, kind, value}); }

  // p3at_session.cpp: the effect of packets on the connection
  void on_packet(const arcos::Packet& packet);
  void sync(const arcos::Command& command);
  void open();
  void close();
  void forget_session();
  void execute(const arcos::Command& command);

  // p3at_commands.cpp: the command table; each returns whether the command is one of its own
  bool execute_motion(const arcos::Command& command);
  bool execute_limits(const arcos::Command& command);
  bool execute_requests(const arcos::Command& command);
  bool execute_parameters(const arcos::Command& command);
  bool execute_tuning(const arcos::Command& command);
  void enable(bool on);
  void switch_sonar(int argument);
  void change_baud(int code);

  // p3at_packets.cpp: the packets it sends
  void send(const arcos::Frame& frame) { line_.from_robot(frame.bytes(), t_ns_); }
  void send_requested_packets();
  void send_config();
  arcos::Sip make_sip();
  arcos::Frame make_encoder_packet() const;
  arcos::Frame make_io_packet() const;
  arcos::Frame make_joystick_packet() const;

  P3AtSettings settings_;
  arcos::ConfigPacket config_;
  TimeNs t_ns_ = 0;      ///< of the last step
  TimeNs t_now_ns_ = 0;  ///< of the last advance()

  RobotLine line_;
  arcos::Parser parser_;
  Session session_ = Session::Waiting;
  bool junk_pending_ = false;
  TimeNs t_last_command_ns_ = 0;
  TimeNs t_next_sip_ns_ = 0;
  Request config_request_ = Request::No;
  Request encoder_request_ = Request::No;
  Request io_request_ = Request::No;
  Request joystick_request_ = Request::No;

  Drive drive_;
  Chassis chassis_;
  SonarRing sonar_;
  StallMonitor stall_left_;
  StallMonitor stall_right_;
  bool motors_enabled_ = false;
  bool watchdog_stopped_ = false;  ///< the setpoints are kept and used again after the next command
  int bump_stall_ = 0;
  bool e_stall_on_button_ = false;
  bool e_stall_engaged_ = false;
  std::uint8_t digital_out_ = 0;
  std::uint8_t ad_port_ = 0;
  double battery_test_v_ = 0.0;  ///< voltage set by BATTEST; 0: the battery's

  FaultSchedule faults_;
  // Set by the world.
  bool button_pressed_ = false;
  std::uint8_t touched_front_ = 0, touched_rear_ = 0;
  bool blocked_left_ = false, blocked_right_ = false;
  // The same together with the active faults.
  bool stop_button_ = false;
  std::uint8_t bumpers_front_ = 0, bumpers_rear_ = 0;
  bool was_stalled_ = false;

  std::vector<RobotEvent> events_;
  std::vector<std::uint8_t> arrived_;
};

}  // namespace heel::sim
