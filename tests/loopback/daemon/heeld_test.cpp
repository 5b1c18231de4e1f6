// heeld drives the simulated robot over a pty towards a person who appears 1 m too far away: it gets ready,
// starts within its acceleration, and whenever it ends (SIGTERM, SIGKILL, end of the camera file) the robot
// stops.
//
// Times are checked by the simulator's own clock, in its truth and its wire file. Time-outs only end a test
// that fails, so a busy machine makes these tests longer and does not make them fail.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <memory>
#include <regex>

#include "core/config.h"
#include "loopback/daemon/heeld_fixture.h"
#include "support/exported.h"
#include "support/full_notify_socket.h"
#include "support/process.h"
#include "support/sanitized.h"
#include "support/socket_client.h"
#include "support/temporary_folder.h"
#include "support/text.h"

namespace heel {
namespace {

using test::all_truth;
using test::event_time_s;
using test::eventually;
using test::last_received_s;
using test::monotonic_s;
using test::newest_truth;
using test::occurrences;
using test::read_text;
using test::sleep_s;
using test::Truth;
using test::write_text;

using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::Matcher;

/// systemd received these messages in this order, with any STATUS between.
bool reloaded_and_ready(const std::vector<std::string>& messages) {
  const auto starts = [](const char* text) {
    return [text](const std::string& message) { return message.starts_with(text); };
  };
  const auto reloading =
      std::find_if(messages.begin(), messages.end(), starts("RELOADING=1\nMONOTONIC_USEC="));
  return std::find_if(reloading, messages.end(), starts("READY=1")) != messages.end();
}

constexpr int kFramesOfAShortFile = test::kSanitized ? 100 : 400;  // 20 s, or 16 s
constexpr double kWatchdog_s = 2.0;                                // of the P3-AT's firmware
constexpr double kStopTimeout_s = 5.0;  // TimeoutStopSec of heeld.service: systemd then kills heeld

class Heeld : public test::HeeldFixture {
 protected:
  using HeeldFixture::HeeldFixture;
};

TEST_F(Heeld, GetsReadyFollowsAndStopsOnSigterm) {
  start_robot();
  start_heeld(scene_.write_config());
  ASSERT_TRUE(notify_.receives("READY=1")) << logs();
  ASSERT_TRUE(starts_to_drive()) << logs();
  EXPECT_TRUE(notify_.receives("STATUS=following"));

  daemon_->signal(SIGTERM);
  EXPECT_EQ(daemon_->wait(), 0) << logs();
  EXPECT_TRUE(notify_.receives("STOPPING=1"));
  EXPECT_THAT(daemon_->output(), HasSubstr("at rest: shutting down"));
  EXPECT_TRUE(robot_->says("closed")) << logs();
  EXPECT_TRUE(comes_to_rest()) << logs();
  // By STOP, not by the watchdog.
  EXPECT_THAT(robot_->output(), Not(HasSubstr("watchdog")));
}

// systemd does not read its notification socket, and the socket is full.
TEST_F(Heeld, StopsTheRobotOnSigtermInTimeWhenSystemdDoesNotRead) {
  test::FullNotifySocket notify(scene_.path("full"));
  double took_s = 0.0;
  for (int attempt = 0; attempt < 3; ++attempt) {
    start_robot();
    start_heeld(scene_.write_config(), notify.name());
    ASSERT_TRUE(starts_to_drive()) << logs();
    const double t_signal_s = monotonic_s();
    daemon_->signal(SIGTERM);
    ASSERT_EQ(daemon_->wait(), 0) << logs();
    took_s = monotonic_s() - t_signal_s;
    ASSERT_TRUE(robot_->says("closed")) << logs();
    ASSERT_TRUE(comes_to_rest()) << logs();
    EXPECT_THAT(robot_->output(), Not(HasSubstr("watchdog")));
    if (took_s < kStopTimeout_s) break;
    robot_.reset();
  }
  EXPECT_LT(took_s, kStopTimeout_s) << logs();
  EXPECT_THAT(notify.take(), testing::IsEmpty()) << "the socket must have been full";
}

TEST_F(Heeld, IsNotReadyWithoutARobotAndGivesTheReason) {
  start_heeld(scene_.write_config());
  EXPECT_TRUE(notify_.receives("STATUS=waiting for the robot")) << daemon_->output();
  EXPECT_FALSE(notify_.receives("READY=1", 1.0));
  EXPECT_TRUE(daemon_->says("cannot open: No such file")) << daemon_->output();
  start_robot();
  EXPECT_TRUE(notify_.receives("READY=1")) << logs();
  daemon_->signal(SIGINT);
  EXPECT_EQ(daemon_->wait(), 0);
}

TEST_F(Heeld, IsReadyBeforeTheRobotIsThereWhereTheConfigurationSaysSo) {
  start_heeld(scene_.write_config({.runtime = "ready_after = \"start\"\n"}));
  EXPECT_TRUE(notify_.receives("READY=1")) << daemon_->output();
  EXPECT_TRUE(notify_.receives("STATUS=waiting for the robot")) << "heeld is ready and waits for the robot";
}

TEST_F(Heeld, LogsWhyTheLineDoesNotOpenOnceForEachReason) {
  start_heeld(scene_.write_config());
  ASSERT_TRUE(daemon_->says("cannot open: No such file")) << daemon_->output();
  write_text(scene_.path("robot"), "no terminal");
  ASSERT_TRUE(daemon_->says("is not a terminal")) << daemon_->output();
  std::filesystem::remove(scene_.path("robot"));
  start_robot();
  ASSERT_TRUE(notify_.receives("READY=1")) << logs();
  sleep_s(1.0);  // the line is tried several times
  EXPECT_LE(occurrences(daemon_->output(), "No such file"), 2)
      << "once before the other reason, and perhaps once after it";
  EXPECT_EQ(occurrences(daemon_->output(), "is not a terminal"), 1) << logs();
}

TEST_F(Heeld, ASecondProgramOnTheLineIsToldWhoHasItAndTheFirstDrivesOn) {
  start_robot();
  start_heeld(scene_.write_config());
  ASSERT_TRUE(starts_to_drive()) << logs();
  const std::string config = write_text(
      scene_.path("second.toml"),
      std::regex_replace(read_text(scene_.path("heel.toml")), std::regex("control.sock"), "second.sock"));
  test::Process second({test::built_program("heeld"), "--config", config});
  EXPECT_TRUE(second.says("in use by heeld (process " + std::to_string(daemon_->pid()) + "); stop it first"))
      << second.output();
  second.signal(SIGTERM);
  EXPECT_EQ(second.wait(), 0);
  // It may have rested while the second one took the processor, and under the thread sanitizer its vision may
  // be too late for long; its line it has had all the time.
  if (!test::kThreadSanitizer) {
    EXPECT_TRUE(starts_to_drive()) << logs();
  }
  EXPECT_EQ(occurrences(daemon_->output(), "robot synchronised"), 1) << logs();
  EXPECT_EQ(occurrences(robot_->output(), "closed"), 0) << logs();
}

TEST_F(Heeld, ARobotThatIsNotTheConfiguredOneIsNotDriven) {
  start_robot({"--model", "p3at"});
  start_heeld(scene_.write_config({.robot = "model = \"p3dx-sh\"\n"}));
  EXPECT_TRUE(notify_.receives("STATUS=at rest: the robot is not driven: it is a p3at")) << logs();
  EXPECT_TRUE(daemon_->says("robot is not driven: it is a p3at, and robot.model is p3dx-sh")) << logs();
  EXPECT_FALSE(notify_.receives("READY=1", 1.0));
  EXPECT_EQ(occurrences(robot_->output(), "opened"), 0) << logs();
  EXPECT_EQ(occurrences(robot_->output(), "enabled"), 0) << logs();
}

TEST_F(Heeld, AnOlderRobotIsDrivenInItsUnits) {
  start_robot({"--model", "p2at"});
  start_heeld(scene_.write_config());
  ASSERT_TRUE(starts_to_drive()) << logs();
  EXPECT_TRUE(daemon_->says("robot synchronised: class Pioneer, subclass p2at; driven as p2at")) << logs();
}

TEST_F(Heeld, KilledWhileDrivingTheRobotStopsByItsWatchdogAndStartsSlowlyAgain) {
  start_robot();
  const std::string config = scene_.write_config();
  start_heeld(config);
  ASSERT_TRUE(starts_to_drive()) << logs();
  daemon_->signal(SIGKILL);
  ASSERT_EQ(daemon_->wait(), -SIGKILL);
  ASSERT_TRUE(robot_->says("watchdog stop")) << logs();
  ASSERT_TRUE(comes_to_rest()) << logs();
  const double t_restart_s = newest_truth(scene_.path("truth.csv")).t_s;
  const double t_last_byte_s = last_received_s(scene_.path("wire.hex")) - robot_started_s_;
  start_heeld(config);
  ASSERT_TRUE(starts_to_drive()) << logs();
  daemon_->signal(SIGTERM);
  EXPECT_EQ(daemon_->wait(), 0);
  robot_->signal(SIGTERM);
  EXPECT_EQ(robot_->wait(), 0);

  const double t_watchdog_s = event_time_s(robot_->output(), "watchdog stop");
  EXPECT_LE(t_watchdog_s - t_last_byte_s, kWatchdog_s + 0.1);
  const std::vector<Truth> truth = all_truth(scene_.path("truth.csv"));
  const auto stood = std::find_if(truth.begin(), truth.end(), [&](const Truth& row) {
    return row.t_s > t_watchdog_s && row.v_m_s == 0.0;
  });
  ASSERT_NE(stood, truth.end());
  const double braking_s = defaults_.gate.v_max_m_s / (1e-3 * defaults_.robot.deceleration_mm_s2);
  EXPECT_LE(stood->t_s - t_watchdog_s, braking_s + 0.1);

  // From the restart on: never faster than the acceleration allows, from rest.
  double last_v = 0.0, last_t = 0.0, fastest = 0.0;
  for (const Truth& row : truth) {
    // Over a tenth of a second, so that the simulator's steps do not count.
    if (row.t_s < t_restart_s || row.t_s - last_t < 0.1) continue;
    if (last_t != 0.0) {
      EXPECT_LE(row.v_m_s - last_v, defaults_.gate.acceleration_m_s2 * (row.t_s - last_t) + 0.05) << row.t_s;
    }
    last_v = row.v_m_s;
    last_t = row.t_s;
    fastest = std::max(fastest, row.v_m_s);
  }
  EXPECT_GT(fastest, 0.1) << "the truth must contain the restart";
  EXPECT_THAT(robot_->output(), Not(HasSubstr("old motion")));
}

TEST_F(Heeld, ReloadIsAllOrNothing) {
  start_robot();
  start_heeld(scene_.write_config());
  ASSERT_TRUE(notify_.receives("READY=1")) << logs();
  ASSERT_TRUE(starts_to_drive()) << logs();

  // A good file is used at once, while driving.
  scene_.write_config({.sections = "[gate]\nv_max_m_s = 0.1\n"});
  daemon_->signal(SIGHUP);
  ASSERT_TRUE(daemon_->says("reloaded")) << logs();
  EXPECT_TRUE(eventually([this] { return reloaded_and_ready(notify_.messages()); })) << logs();
  EXPECT_TRUE(eventually([this] { return speed() > 0.05 && speed() < 0.12; })) << speed();

  // A file with an error and a good change: no change is used.
  scene_.write_config({.sections = "[gate]\nv_max_m_s = 0.6\n[control]\ngain_yaw = 1\n"});
  daemon_->signal(SIGHUP);
  ASSERT_TRUE(daemon_->says("did you mean control.gain_yaw_1_s?"));
  ASSERT_TRUE(daemon_->says("the old configuration stays"));

  // A key that cannot change while running.
  scene_.write_config({.sections = "[gate]\nv_max_m_s = 0.6\n[vision]\noctaves = 3\n"});
  daemon_->signal(SIGHUP);
  ASSERT_TRUE(daemon_->says("vision.octaves cannot change while running"));

  // Values that do not fit the camera's calibration.
  scene_.write_config({.sections = "[gate]\nv_max_m_s = 0.6\n[control]\nbearing_max_rad = 0.6\n"});
  daemon_->signal(SIGHUP);
  ASSERT_TRUE(daemon_->says("control.bearing_max_rad: 0.6 (expected less than"));
  sleep_s(1.0);
  EXPECT_LT(speed(), 0.12);
  EXPECT_TRUE(daemon_->running());
}

TEST_F(Heeld, ReloadChangesTheLogLevel) {
  start_heeld(scene_.write_config());
  ASSERT_TRUE(notify_.receives("STATUS=waiting for the robot")) << daemon_->output();
  scene_.write_config({.sections = "[gate]\nv_max_m_s = 0.125\n", .runtime = "log_level = \"error\"\n"});
  daemon_->signal(SIGHUP);
  ASSERT_TRUE(notify_.receives("RELOADING=1")) << daemon_->output();
  // A reload is done by the settings thread: only its values show that it has ended.
  test::SocketClient client(scene_.path("control.sock"));
  ASSERT_TRUE(eventually([&] {
    return client.ask("{\"do\":\"status\"}").find("\"gate.v_max_m_s\":0.125") != std::string::npos;
  })) << daemon_->output();
  daemon_->signal(SIGTERM);
  EXPECT_EQ(daemon_->wait(), 0);
  EXPECT_THAT(daemon_->output(), HasSubstr("configuration: "));
  EXPECT_THAT(daemon_->output(), Not(HasSubstr("heeld stopped"))) << "a message of level info";
}

class HeeldWithOneFrame : public Heeld {
 protected:
  HeeldWithOneFrame() : Heeld(1) {}
};

TEST_F(HeeldWithOneFrame, FollowsACameraFileThatStartsAgain) {
  start_robot();
  start_heeld(scene_.write_config({.camera = "at_end = \"loop\"\n"}));
  EXPECT_TRUE(starts_to_drive()) << logs();
}

class HeeldWithAShortCameraFile : public Heeld {
 protected:
  HeeldWithAShortCameraFile() : Heeld(kFramesOfAShortFile) {}
};

TEST_F(HeeldWithAShortCameraFile, ComesToRestAtTheEndAndKeepsTheRecording) {
  const std::string frames = std::to_string(kFramesOfAShortFile);
  start_robot();
  start_heeld(scene_.write_config({.sections = "[telemetry]\ndirectory = \"run\"\n"}));
  ASSERT_TRUE(starts_to_drive()) << logs();
  EXPECT_EQ(daemon_->wait(), 0) << logs();
  // Where vision takes longer than the time-outs, what was seen last is too old before the silence is.
  EXPECT_THAT(daemon_->output(), test::kThreadSanitizer
                                     ? Matcher<std::string>(AnyOf(HasSubstr("at rest: camera silent"),
                                                                  HasSubstr("at rest: target lost")))
                                     : Matcher<std::string>(HasSubstr("at rest: camera silent")));
  EXPECT_TRUE(robot_->says("closed")) << logs();
  EXPECT_TRUE(comes_to_rest());
  EXPECT_THAT(robot_->output(), Not(HasSubstr("watchdog")));
  test::exported(scene_.path("run"));
  EXPECT_GT(read_text(scene_.path("run/ticks.csv")).size(), 10000u);
  EXPECT_GT(read_text(scene_.path("run/poses.csv")).size(), 10000u);
  EXPECT_THAT(daemon_->output(), HasSubstr("camera: " + frames + " frames, 0 dropped by the driver"));
  EXPECT_THAT(daemon_->output(), HasSubstr(" packets, 0 with a wrong checksum"));
  EXPECT_THAT(read_text(scene_.path("run/capture.csv")), HasSubstr("," + frames + ",0,"));
}

TEST_F(Heeld, NothingMovesBeforeAStart) {
  start_robot();
  start_heeld(scene_.write_config({.start = "operator"}));
  ASSERT_TRUE(notify_.receives("READY=1")) << logs();
  EXPECT_TRUE(notify_.receives("STATUS=at rest: not started; `heel start` lets the robot move")) << logs();
  sleep_s(3.0);
  EXPECT_EQ(speed(), 0.0) << logs();
  EXPECT_THAT(daemon_->output(), Not(HasSubstr("at_once")));
  for (const test::Truth& truth : test::all_truth(scene_.path("truth.csv"))) ASSERT_EQ(truth.v_m_s, 0.0);
}

TEST_F(Heeld, StartingAtOnceIsSaidInTheLog) {
  start_heeld(scene_.write_config());
  EXPECT_TRUE(daemon_->says("warning supervisor.start = \"at_once\"")) << logs();
}

TEST_F(Heeld, StopButtonHoldsTheRobotUntilHeeldIsRestarted) {
  const std::string config = scene_.write_config();
  // The button is pressed at a fixed time after the simulator's start. On a busy machine a later time is
  // tried.
  for (const int pressed_at_s : {8, 30, 90}) {
    start_robot({"--fault", "stop_button@" + std::to_string(pressed_at_s) + "+1"});
    start_heeld(config);
    ASSERT_TRUE(eventually([this] { return speed() > 0.2 || robot_->says("fault stop_button", 0.0); }))
        << logs();
    if (!robot_->says("fault stop_button", 0.0)) break;
    daemon_.reset();
    robot_.reset();
  }
  ASSERT_TRUE(daemon_) << "the robot was not driving after 90 s";
  EXPECT_TRUE(daemon_->says("at rest: stop button pressed")) << logs();
  EXPECT_TRUE(daemon_->says("motors stay off until `heel reset`")) << logs();
  EXPECT_TRUE(comes_to_rest());
  sleep_s(2.0);
  EXPECT_EQ(speed(), 0.0) << "the button has been released";

  daemon_->signal(SIGTERM);
  EXPECT_EQ(daemon_->wait(), 0) << logs();
  start_heeld(config);
  EXPECT_TRUE(starts_to_drive()) << logs();
}

}  // namespace
}  // namespace heel
