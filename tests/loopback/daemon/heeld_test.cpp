// The real daemon drives the real simulated robot over a pty towards a person shown 1 m too far away: it gets
// ready, starts gently, and on every way out (SIGTERM, SIGKILL, the end of the film) the wheels stand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <memory>

#include "loopback/daemon/scene.h"
#include "support/process.h"

namespace heel::test {
namespace {

using ::testing::HasSubstr;

/// Told to systemd in this order, whatever STATUS comes between.
bool reloaded_and_ready(const std::vector<std::string>& messages) {
  const auto starts = [](const char* text) {
    return [text](const std::string& message) { return message.starts_with(text); };
  };
  const auto reloading =
      std::find_if(messages.begin(), messages.end(), starts("RELOADING=1\nMONOTONIC_USEC="));
  return std::find_if(reloading, messages.end(), starts("READY=1")) != messages.end();
}

class Heeld : public ::testing::Test {
 protected:
  explicit Heeld(int frames = 2000) : scene_(frames) {}

  void start_robot(std::vector<std::string> more = {}) {
    std::vector<std::string> argv = {HEEL_SIM_PROGRAM, "--robot", "pty:" + scene_.path("robot"),
                                     "--exact",        "--truth", scene_.path("truth.csv"),
                                     "--truth-rate",   "500"};
    argv.insert(argv.end(), more.begin(), more.end());
    robot_ = std::make_unique<Process>(argv, scene_.path("robot.log"));
    ASSERT_TRUE(robot_->says("ready at", 10.0)) << robot_->output();
  }
  void start_heeld(const std::string& config) {
    daemon_ = std::make_unique<Process>(
        std::vector<std::string>{HEELD_PROGRAM, "--config", config}, scene_.path("heeld.log"),
        std::map<std::string, std::string>{{"NOTIFY_SOCKET", notify_.path()}});
  }
  double speed() const { return newest_truth(scene_.path("truth.csv")).v_m_s; }
  bool drives(double timeout_s) {
    return eventually([this] { return speed() > 0.2; }, timeout_s);
  }
  bool stands(double timeout_s) {
    return eventually([this] { return speed() == 0.0; }, timeout_s);
  }
  std::string logs() { return daemon_->output() + "\n--- robot\n" + robot_->output(); }

  Scene scene_;
  NotifySocket notify_{scene_.path("notify")};
  std::unique_ptr<Process> robot_, daemon_;
};

TEST_F(Heeld, GetsReadyFollowsAndStopsOnSigterm) {
  start_robot();
  start_heeld(scene_.write_config());
  ASSERT_TRUE(notify_.receives("READY=1", 30.0)) << logs();
  ASSERT_TRUE(drives(30.0)) << logs();
  EXPECT_TRUE(notify_.receives("STATUS=following", 1.0));

  daemon_->signal(SIGTERM);
  EXPECT_EQ(daemon_->wait(5.0), 0) << logs();
  EXPECT_TRUE(notify_.receives("STOPPING=1", 0.1));
  EXPECT_TRUE(daemon_->says("at rest: shutting down", 0.1)) << logs();
  EXPECT_TRUE(robot_->says("closed", 2.0)) << logs();
  EXPECT_TRUE(stands(2.0)) << logs();
  // By STOP, not by the watchdog.
  EXPECT_THAT(robot_->output(), Not(HasSubstr("watchdog")));
}

TEST_F(Heeld, IsNotReadyWithoutARobotAndSaysWhy) {
  start_heeld(scene_.write_config());
  EXPECT_TRUE(notify_.receives("STATUS=waiting for the robot", 10.0)) << daemon_->output();
  EXPECT_FALSE(notify_.receives("READY=1", 1.0));
  EXPECT_TRUE(daemon_->says("warn", 5.0)) << daemon_->output();  // the line does not open, and why
  start_robot();
  EXPECT_TRUE(notify_.receives("READY=1", 30.0)) << logs();
  daemon_->signal(SIGINT);
  EXPECT_EQ(daemon_->wait(5.0), 0);
}

TEST_F(Heeld, IsReadyBeforeTheRobotIsThereWhereTheConfigurationSaysSo) {
  const std::string config = scene_.write_config();
  std::string text = content_of(config);
  const std::string table = "[runtime]\n";
  text.insert(text.find(table) + table.size(), "ready_after = \"start\"\n");
  std::ofstream(config) << text;
  start_heeld(config);
  EXPECT_TRUE(notify_.receives("READY=1", 10.0)) << daemon_->output();
  EXPECT_TRUE(notify_.receives("STATUS=waiting for the robot", 10.0)) << "ready, and still waiting";
}

TEST_F(Heeld, SaysWhyTheLineDoesNotOpenOnceForEachReason) {
  const auto lines = [this](const std::string& what) {
    const std::string text = daemon_->output();
    int n = 0;
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
    return n;
  };
  start_heeld(scene_.write_config());
  ASSERT_TRUE(daemon_->says("cannot open: No such file", 30.0)) << daemon_->output();
  std::ofstream(scene_.path("robot")) << "no terminal";
  ASSERT_TRUE(daemon_->says("is not a terminal", 10.0)) << daemon_->output();
  std::filesystem::remove(scene_.path("robot"));
  start_robot();
  ASSERT_TRUE(notify_.receives("READY=1", 30.0)) << logs();
  // Long enough for several rounds of whoever tells.
  sleep_s(1.0);
  EXPECT_LE(lines("No such file"), 2) << logs();  // before the other reason, and perhaps after it
  EXPECT_EQ(lines("is not a terminal"), 1) << logs();
}

TEST_F(Heeld, KilledWhileTheWheelsTurnTheRobotStandsWithinItsWatchdogAndDoesNotJumpAfter) {
  start_robot();
  const std::string config = scene_.write_config();
  start_heeld(config);
  ASSERT_TRUE(drives(30.0)) << logs();
  daemon_->signal(SIGKILL);
  ASSERT_EQ(daemon_->wait(5.0), -SIGKILL);
  // 2 s of watchdog, and braking from 0.7 m/s at 1.5 m/s².
  EXPECT_TRUE(stands(2.0 + 0.7 / 1.5 + 0.5)) << logs();
  EXPECT_THAT(robot_->output(), HasSubstr("watchdog stop"));

  const double t_restart_s = newest_truth(scene_.path("truth.csv")).t_s;
  start_heeld(config);
  ASSERT_TRUE(drives(30.0)) << logs();
  // From the restart on: never faster than the acceleration allows, from rest.
  daemon_->signal(SIGTERM);
  daemon_->wait(5.0);
  robot_->signal(SIGTERM);
  robot_->wait(5.0);
  double last_v = 0.0, last_t = 0.0;
  for (const Truth& row : all_truth(scene_.path("truth.csv"))) {
    // Over a tenth of a second, so that the simulator's steps do not count.
    if (row.t_s < t_restart_s || row.t_s - last_t < 0.1) continue;
    if (last_t != 0.0) {
      EXPECT_LE(row.v_m_s - last_v, 0.6 * (row.t_s - last_t) + 0.05) << row.t_s;
    }
    last_v = row.v_m_s;
    last_t = row.t_s;
  }
  EXPECT_THAT(robot_->output(), Not(HasSubstr("old motion")));
}

TEST_F(Heeld, ReloadIsAllOrNothing) {
  start_robot();
  start_heeld(scene_.write_config());
  ASSERT_TRUE(notify_.receives("READY=1", 30.0)) << logs();
  ASSERT_TRUE(drives(30.0)) << logs();

  // Good: taken over while driving.
  scene_.write_config("[gate]\nv_max_m_s = 0.1\n");
  daemon_->signal(SIGHUP);
  ASSERT_TRUE(daemon_->says("reloaded", 5.0)) << logs();
  EXPECT_TRUE(eventually([this] { return reloaded_and_ready(notify_.messages()); }, 1.0)) << logs();
  EXPECT_TRUE(eventually([this] { return speed() > 0.05 && speed() < 0.12; }, 5.0)) << speed();

  // An error, and beside it a good change: nothing of it is taken.
  scene_.write_config("[gate]\nv_max_m_s = 0.6\n[control]\ngain_yaw = 1\n");
  daemon_->signal(SIGHUP);
  ASSERT_TRUE(daemon_->says("did you mean control.gain_yaw_1_s?", 5.0));
  ASSERT_TRUE(daemon_->says("the old configuration stays", 5.0));

  // A key that cannot change while running.
  scene_.write_config("[gate]\nv_max_m_s = 0.6\n[vision]\noctaves = 3\n");
  daemon_->signal(SIGHUP);
  ASSERT_TRUE(daemon_->says("vision.octaves cannot change while running", 5.0));
  sleep_s(1.0);
  EXPECT_LT(speed(), 0.12);
  EXPECT_TRUE(daemon_->running());
}

class HeeldWithOnePicture : public Heeld {
 protected:
  HeeldWithOnePicture() : Heeld(1) {}
};

TEST_F(HeeldWithOnePicture, FollowsAFilmThatBeginsAgain) {
  start_robot();
  const std::string config = scene_.write_config();
  const std::string text = content_of(config);
  std::ofstream(config) << text.substr(0, 9) << "at_end = \"loop\"\n" << text.substr(9);  // after [camera]
  start_heeld(config);
  EXPECT_TRUE(drives(30.0)) << logs();
}

class HeeldWithAShortFilm : public Heeld {
 protected:
  HeeldWithAShortFilm() : Heeld(250) {}
};

TEST_F(HeeldWithAShortFilm, ComesToRestAtItsEndAndLeavesARecording) {
  start_robot();
  start_heeld(scene_.write_config("[telemetry]\ndirectory = \"run\"\n"));
  ASSERT_TRUE(drives(30.0)) << logs();
  EXPECT_EQ(daemon_->wait(70.0), 0) << logs();
  EXPECT_TRUE(daemon_->says("at rest: camera silent", 0.1)) << logs();
  EXPECT_TRUE(robot_->says("closed", 2.0)) << logs();
  EXPECT_TRUE(stands(2.0));
  EXPECT_THAT(robot_->output(), Not(HasSubstr("watchdog")));
  EXPECT_GT(content_of(scene_.path("run/ticks.csv")).size(), 10000u);
  EXPECT_GT(content_of(scene_.path("run/poses.csv")).size(), 10000u);
  EXPECT_TRUE(daemon_->says("camera: 250 frames, 0 dropped by the driver", 1.0)) << logs();
  EXPECT_TRUE(daemon_->says(" packets, 0 with a wrong checksum", 1.0)) << logs();
  EXPECT_THAT(content_of(scene_.path("run/capture.csv")), HasSubstr(",250,0,"));
}

TEST_F(Heeld, StopButtonHoldsTheRobotUntilHeeldIsRestarted) {
  start_robot({"--fault", "stop_button@15+1"});
  const std::string config = scene_.write_config();
  start_heeld(config);
  ASSERT_TRUE(drives(14.0)) << logs();
  EXPECT_TRUE(daemon_->says("at rest: stop button pressed", 20.0)) << logs();
  EXPECT_TRUE(daemon_->says("motors stay off until heeld is restarted", 1.0)) << logs();
  EXPECT_TRUE(stands(2.0));
  sleep_s(2.0);
  EXPECT_EQ(speed(), 0.0) << "the button was released meanwhile";

  daemon_->signal(SIGTERM);
  EXPECT_EQ(daemon_->wait(5.0), 0) << logs();
  start_heeld(config);
  EXPECT_TRUE(drives(30.0)) << logs();
}

}  // namespace
}  // namespace heel::test
