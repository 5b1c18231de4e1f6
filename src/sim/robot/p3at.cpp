// One step of the P3-AT: switches, line, watchdog, wheels, sonars, packets.
#include "sim/robot/p3at.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/robot/make_config.h"

namespace heel::sim {
namespace {

constexpr TimeNs kLongestPacket_ns = 300 * kNsPerMs;  // 252 bytes at 9600 baud take 263 ms
constexpr double kStep_s = static_cast<double>(P3At::kStep_ns) * 1e-9;

AxisLimits radians(const AxisLimits& degrees) {
  constexpr double kRad = std::numbers::pi / 180.0;
  return {degrees.speed * kRad, degrees.acceleration * kRad, degrees.deceleration * kRad};
}

}  // namespace

const char* to_string(Session session) {
  switch (session) {
    case Session::Waiting:
      return "waiting";
    case Session::Synced0:
      return "synced0";
    case Session::Synced1:
      return "synced1";
    case Session::Connected:
      return "connected";
    case Session::Open:
      return "open";
    case Session::Maintenance:
      return "maintenance";
  }
  return "?";
}

P3At::P3At(const P3AtSettings& settings, std::uint64_t seed)
    : settings_(settings),
      config_(make_config(settings)),
      line_(settings.boot_baud, seed + 1),
      junk_pending_(settings.junk_before_first_echo),
      drive_(settings.translation_boot, radians(settings.rotation_boot_deg),
             settings.chassis.effective_track_m),
      chassis_(settings.chassis, seed),
      sonar_(settings.model),
      stall_left_(settings.stall_cut_ns),
      stall_right_(settings.stall_cut_ns),
      bump_stall_(settings.bump_stall) {
  chassis_.place(settings.start);
  sonar_.set_cycle(settings.sonar_cycle_ns);
  for (const Fault& fault : settings.faults) faults_.add(fault);
}

void P3At::receive(std::span<const std::uint8_t> bytes, TimeNs t_ns) {
  line_.from_host(bytes, std::max(t_ns, t_ns_));
}

void P3At::advance(TimeNs t_ns) {
  while (t_ns_ + kStep_ns <= t_ns) {
    t_ns_ += kStep_ns;
    step();
  }
  t_now_ns_ = std::max(t_now_ns_, t_ns);
}

std::vector<std::uint8_t> P3At::take_output() {
  std::vector<std::uint8_t> out;
  line_.arrive_at_host(t_now_ns_, out);
  return out;
}

void P3At::line_dropped() {
  if (session_ != Session::Open && session_ != Session::Maintenance) session_ = Session::Waiting;
}

void P3At::touch_bumper(std::uint8_t front, std::uint8_t rear) {
  touched_front_ = front & 0x7F;
  touched_rear_ = rear & 0x7F;
}

void P3At::block_wheels(bool left, bool right) {
  blocked_left_ = left;
  blocked_right_ = right;
}

std::vector<RobotEvent> P3At::take_events() {
  return std::exchange(events_, {});
}

RobotTruth P3At::truth() const {
  const bool bumped = pushes_against_bumper();
  return {.t_ns = t_now_ns_,
          .pose = chassis_.true_pose(),
          .v_m_s = chassis_.true_speed_m_s(),
          .yaw_rate_rad_s = chassis_.true_yaw_rate_rad_s(),
          .odometry = chassis_.odometry(),
          .wheels = chassis_.wheels(),
          .session = session_,
          .motors_enabled = motors_enabled_,
          .watchdog_stopped = watchdog_stopped_,
          .stall_left = bumped || e_stall_engaged_ || stall_left_.stalled(t_ns_),
          .stall_right = bumped || e_stall_engaged_ || stall_right_.stalled(t_ns_),
          .stop_button = stop_button_,
          .bumpers_front = bumpers_front_,
          .bumpers_rear = bumpers_rear_,
          .baud = line_.robot_baud()};
}

void P3At::step() {
  for (const Fault& fault : faults_.advance(t_ns_)) begin_fault(fault);
  line_.set_effects(faults_.effects());
  read_switches();
  read_line();
  check_watchdog();
  turn_wheels();
  sonar_.advance(t_ns_, chassis_.true_pose());
  send_due_packets();
}

void P3At::begin_fault(const Fault& fault) {
  log(RobotEventKind::FaultBegins, static_cast<int>(fault.kind));
  if (fault.kind == FaultKind::Reset) {
    reset(fault.amount == 255.0 ? 0xFF : 0xFE);
  } else if (fault.kind == FaultKind::BootBaud) {
    settings_.boot_baud = static_cast<int>(fault.amount);
    reset();
  } else if (fault.kind == FaultKind::LeftOpen) {
    open();
    motors_enabled_ = true;
    drive_.set_speed(fault.amount * 1e-3);
    watchdog_stopped_ = settings_.watchdog_ns > 0;
  }
}

void P3At::read_switches() {
  const FaultEffects& effects = faults_.effects();
  const auto front = static_cast<std::uint8_t>(touched_front_ | effects.bumpers_front);
  const auto rear = static_cast<std::uint8_t>(touched_rear_ | effects.bumpers_rear);
  if (front != bumpers_front_ || rear != bumpers_rear_) log(RobotEventKind::Bumpers, front | rear << 8);
  bumpers_front_ = front;
  bumpers_rear_ = rear;
  chassis_.block(blocked_left_ || effects.blocked_left, blocked_right_ || effects.blocked_right);

  const bool pressed = button_pressed_ || effects.stop_button;
  if (pressed != stop_button_) log(pressed ? RobotEventKind::StopButton : RobotEventKind::StopButtonFree);
  stop_button_ = pressed;
  if (!pressed) return;
  motors_enabled_ = false;
  if (e_stall_on_button_) e_stall_engaged_ = true;
}

void P3At::read_line() {
  arrived_.clear();
  line_.arrive_at_robot(t_ns_, arrived_);
  if (session_ == Session::Maintenance) return;
  const auto take = [this](const arcos::Packet& packet) { on_packet(packet); };
  parser_.feed(arrived_, t_ns_, take);
  parser_.give_up_before(t_ns_ - kLongestPacket_ns, take);
}

void P3At::check_watchdog() {
  if (session_ != Session::Open || watchdog_stopped_ || settings_.watchdog_ns <= 0) return;
  if (t_ns_ - t_last_command_ns_ < settings_.watchdog_ns) return;
  watchdog_stopped_ = true;
  log(RobotEventKind::WatchdogStop);
}

Drive::Progress P3At::progress() const {
  return {chassis_.odometry().heading_rad, 0.5 * (chassis_.left_travel_m() + chassis_.right_travel_m())};
}

bool P3At::pushes_against_bumper() const {
  if (!motors_enabled_ || watchdog_stopped_) return false;
  const int direction = drive_.direction(progress().travelled_m);
  return (direction > 0 && bumpers_front_ != 0 && (bump_stall_ & 1) != 0) ||
         (direction < 0 && bumpers_rear_ != 0 && (bump_stall_ & 2) != 0);
}

bool P3At::stalled() const {
  return pushes_against_bumper() || stall_left_.stalled(t_ns_) || stall_right_.stalled(t_ns_);
}

void P3At::turn_wheels() {
  const bool stalled_now = stalled();
  if (stalled_now != was_stalled_) log(stalled_now ? RobotEventKind::Stalled : RobotEventKind::StallOver);
  was_stalled_ = stalled_now;

  const bool powered = motors_enabled_ && !stalled_now;
  WheelSpeeds target;
  if (powered) {
    target = drive_.step(progress(), watchdog_stopped_, kStep_s);
    chassis_.drive(target, kStep_s);
  } else {
    chassis_.coast(kStep_s);
    drive_.follow(chassis_.wheels());
  }
  const WheelSpeeds& actual = chassis_.wheels();
  stall_left_.step(powered, target.left_m_s, actual.left_m_s, t_ns_, kStep_ns);
  stall_right_.step(powered, target.right_m_s, actual.right_m_s, t_ns_, kStep_ns);
}

void P3At::send_due_packets() {
  if (session_ != Session::Open || t_ns_ < t_next_sip_ns_) return;
  t_next_sip_ns_ += settings_.sip_cycle_ns;
  // On a line that is too slow for everything requested, whole cycles are left out, not bytes.
  if (line_.output_free_at_ns() > t_ns_ + settings_.sip_cycle_ns) return;
  send_requested_packets();
  send(arcos::encode_sip(make_sip()));
}

void P3At::reset(std::uint8_t notice_id) {
  forget_session();
  drive_ = Drive(settings_.translation_boot, radians(settings_.rotation_boot_deg),
                 settings_.chassis.effective_track_m);
  chassis_.zero_odometry();
  config_ = make_config(settings_);
  sonar_.set_polling({});
  sonar_.set_cycle(settings_.sonar_cycle_ns);
  bump_stall_ = settings_.bump_stall;
  e_stall_on_button_ = false;
  e_stall_engaged_ = false;
  digital_out_ = 0;
  ad_port_ = 0;
  battery_test_v_ = 0.0;
  junk_pending_ = settings_.junk_before_first_echo;
  parser_.reset();
  line_.set_robot_baud(settings_.boot_baud);
  const std::uint8_t notice[] = {notice_id};
  send(arcos::frame_body(notice));
  log(RobotEventKind::Reset, notice_id);
}

}  // namespace heel::sim
