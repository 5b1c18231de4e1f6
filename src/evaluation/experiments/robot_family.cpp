#include "evaluation/experiments/robot_family.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "control/gate.h"
#include "control/sonar_obstacles.h"
#include "files/csv_file.h"
#include "heel/error.h"
#include "models/robot_models.h"
#include "robot/arcos_session.h"
#include "sim/robot/p3at.h"

namespace heel::evaluation {
namespace {

constexpr TimeNs kTick_ns = 20 * kNsPerMs;
constexpr double kStraight_m = 5.0;
constexpr double kTurn_rad = 2.0 * std::numbers::pi;
constexpr double kStraightSpeed_m_s = 0.4;
constexpr double kTurnRate_rad_s = 0.5;
constexpr double kWall_m = 3.5;
constexpr double kToConnect_s = 10.0;
constexpr double kToRest_s = 2.0;
constexpr double kToWall_s = 15.0;
constexpr double kTooLong_s = 60.0;
constexpr int kFamilyDecimals = 4;

/// The robot, its line, heeld's session, and the gate between the wanted velocity and the session.
class FamilyBench {
 public:
  FamilyBench(const sim::P3AtSettings& settings, const Config& config, std::uint64_t seed)
      : config_(with_line(config)),
        robot_(settings, seed),
        session_(config_.robot),
        obstacles_(settings.model.geometry) {
    session_.line_opened(0);
  }

  TimeNs now_ns() const { return now_ns_; }
  void connect() {
    while (now_ns_ < ns_from_seconds(kToConnect_s) && state().phase != LinkPhase::Running) tick(0.0, 0.0);
    if (state().phase != LinkPhase::Running)
      throw Error(fmt::format("{}: the session is {} after {} s (expected running)", robot_.model().subclass,
                              to_string(state().phase), kToConnect_s));
  }
  void set_wall(double x_m) {
    robot_.set_range_finder([x_m](const Pose2& sensor) {
      const double c = std::cos(sensor.heading_rad);
      return c > 1e-3 ? (x_m - sensor.x_m) / c : std::numeric_limits<double>::infinity();
    });
  }
  void tick(double v_m_s, double yaw_rate_rad_s) {
    for (const TimeNs to_ns = now_ns_ + kTick_ns; now_ns_ < to_ns;) {
      now_ns_ += sim::P3At::kStep_ns;
      robot_.advance(now_ns_);
      session_.receive(robot_.take_output(), now_ns_);
    }
    session_.advance(now_ns_);
    if (state().has_sip) obstacles_.update(state());
    VelocityCommand wanted;
    wanted.t_issued_ns = now_ns_;
    wanted.t_expires_ns = now_ns_ + ns_from_seconds(config_.gate.command_lifetime_s);
    wanted.v_m_s = v_m_s;
    wanted.yaw_rate_rad_s = yaw_rate_rad_s;
    const Clearances clearances{std::numeric_limits<double>::infinity(),
                                obstacles_.obstacles_at(now_ns_, state().odometry),
                                state().limits.deceleration_m_s2};
    last_ = apply_gate(wanted, last_, StopStyle::Go, clearances, now_ns_, config_.gate).command;
    robot_.receive(session_.send(last_, now_ns_), now_ns_);
  }
  void run(double v_m_s, double yaw_rate_rad_s, double seconds) {
    for (const TimeNs end_ns = now_ns_ + ns_from_seconds(seconds); now_ns_ < end_ns;)
      tick(v_m_s, yaw_rate_rad_s);
  }
  /// Until `arrived` says so; throws heel::Error when that takes too long.
  template <typename Arrived>
  void run_until(double v_m_s, double yaw_rate_rad_s, Arrived arrived) {
    for (const TimeNs end_ns = now_ns_ + ns_from_seconds(kTooLong_s); !arrived(truth().pose);) {
      if (now_ns_ > end_ns) throw Error(fmt::format("{}: does not arrive", robot_.model().subclass));
      tick(v_m_s, yaw_rate_rad_s);
    }
  }

  const RobotState& state() const { return session_.state(); }
  sim::RobotTruth truth() const { return robot_.truth(); }

 private:
  static Config with_line(Config config) {
    config.robot.address = "pty:family@38400";
    return config;
  }

  Config config_;
  sim::P3At robot_;
  ArcosSession session_;
  SonarObstacleMap obstacles_;
  VelocityCommand last_;
  TimeNs now_ns_ = 0;
};

sim::P3AtSettings settings_of(const std::string& subclass) {
  sim::P3AtSettings settings = sim::settings_of_model(subclass);
  settings.boot_baud = 38400;
  return settings;
}

void drive_straight_and_turn(const Config& config, std::uint64_t seed, FamilyDrive& drive) {
  sim::P3AtSettings settings = settings_of(drive.subclass);
  settings.chassis = sim::exact_chassis(settings.chassis);
  FamilyBench bench(settings, config, seed);
  bench.connect();
  bench.run_until(kStraightSpeed_m_s, 0.0, [](const Pose2& at) { return at.x_m >= 0.5 * kStraight_m; });
  drive.speed_truth_m_s = bench.truth().v_m_s;
  drive.speed_odometry_m_s = bench.state().odometry.v_m_s;
  bench.run_until(kStraightSpeed_m_s, 0.0, [](const Pose2& at) { return at.x_m >= kStraight_m; });
  bench.run(0.0, 0.0, kToRest_s);
  drive.straight_truth_m = bench.truth().pose.x_m;
  drive.straight_odometry_m = bench.state().odometry.x_m;
  bench.run_until(0.0, kTurnRate_rad_s, [](const Pose2& at) { return at.heading_rad >= kTurn_rad; });
  bench.run(0.0, 0.0, kToRest_s);
  drive.turn_truth_rad = bench.truth().pose.heading_rad;
  drive.turn_odometry_rad = bench.state().odometry.heading_rad;
}

void drive_to_wall(const Config& config, std::uint64_t seed, FamilyDrive& drive) {
  const sim::P3AtSettings settings = settings_of(drive.subclass);
  FamilyBench bench(settings, config, seed);
  bench.set_wall(kWall_m);
  bench.connect();
  for (const TimeNs end_ns = bench.now_ns() + ns_from_seconds(kToWall_s); bench.now_ns() < end_ns;) {
    bench.tick(config.gate.v_max_m_s, 0.0);
    drive.wall_speed_m_s = std::max(drive.wall_speed_m_s, bench.truth().v_m_s);
  }
  drive.wall_gap_m = kWall_m - bench.truth().pose.x_m - settings.model.geometry.front_m;
}

}  // namespace

FamilyDrive drive_model(const std::string& subclass, const Config& config, std::uint64_t seed) {
  FamilyDrive drive;
  drive.subclass = subclass;
  drive_straight_and_turn(config, seed, drive);
  drive_to_wall(config, seed, drive);
  return drive;
}

std::vector<FamilyDrive> drive_family(const Config& config, std::uint64_t seed,
                                      const ProgressCallback& on_progress) {
  std::vector<FamilyDrive> drives;
  for (const RobotModel& model : robot_models()) {
    drives.push_back(drive_model(model.subclass, config, seed));
    on_progress(drives.size(), robot_models().size());
  }
  return drives;
}

void write_family(const std::vector<FamilyDrive>& drives, const std::string& path) {
  CsvFile file(
      path,
      "subclass,straight_truth_m,straight_odometry_m,turn_truth_rad,turn_odometry_rad,speed_truth_m_s,"
      "speed_odometry_m_s,wall_speed_m_s,wall_gap_m");
  for (const FamilyDrive& d : drives) {
    file.text(d.subclass);
    for (const double value :
         {d.straight_truth_m, d.straight_odometry_m, d.turn_truth_rad, d.turn_odometry_rad, d.speed_truth_m_s,
          d.speed_odometry_m_s, d.wall_speed_m_s, d.wall_gap_m})
      file.number(value, kFamilyDecimals);
    file.end_row();
  }
  file.flush();
}

std::string family_table(const std::vector<FamilyDrive>& drives) {
  std::string text =
      "| robot | straight: truth, odometry (m) | turn: truth, odometry (°) | speed: truth, odometry (m/s) | "
      "speed towards the wall (m/s) | stands before the wall (m) |\n|---|---|---|---|---|---|\n";
  constexpr double kDeg = 180.0 / std::numbers::pi;
  for (const FamilyDrive& d : drives)
    text += fmt::format("| {} | {:.2f}, {:.2f} | {:.1f}, {:.1f} | {:.3f}, {:.3f} | {:.2f} | {:.2f} |\n",
                        d.subclass, d.straight_truth_m, d.straight_odometry_m, kDeg * d.turn_truth_rad,
                        kDeg * d.turn_odometry_rad, d.speed_truth_m_s, d.speed_odometry_m_s, d.wall_speed_m_s,
                        d.wall_gap_m);
  return text;
}

}  // namespace heel::evaluation
