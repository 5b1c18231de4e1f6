// heeld and heel-sim as processes on a scene, over a pty.
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/config.h"
#include "loopback/daemon/scene.h"
#include "support/process.h"

namespace heel::test {

/// The camera file lasts longer than any test waits.
inline constexpr int kFramesOfALongFile = 4000;

class HeeldFixture : public ::testing::Test {
 protected:
  explicit HeeldFixture(int frames = kFramesOfALongFile) : scene_(frames) {}

  void start_robot(const std::vector<std::string>& more = {}) {
    std::vector<std::string> argv = {test::built_program("heel-sim"),
                                     "--robot",
                                     "pty:" + scene_.path("robot"),
                                     "--exact",
                                     "--truth",
                                     scene_.path("truth.csv"),
                                     "--truth-rate",
                                     "500",
                                     "--wire",
                                     scene_.path("wire.hex")};
    argv.insert(argv.end(), more.begin(), more.end());
    robot_started_s_ = monotonic_s();
    robot_ = std::make_unique<Process>(argv, scene_.path("robot.log"));
    ASSERT_TRUE(robot_->says("ready at")) << robot_->output();
  }
  void start_heeld(const std::string& config) { start_heeld(config, notify_.path()); }
  void start_heeld(const std::string& config, const std::string& notify_socket) {
    daemon_ = std::make_unique<Process>(
        std::vector<std::string>{test::built_program("heeld"), "--config", config}, scene_.path("heeld.log"),
        std::map<std::string, std::string>{{"NOTIFY_SOCKET", notify_socket}});
  }
  double speed() const { return newest_truth(scene_.path("truth.csv")).v_m_s; }
  bool starts_to_drive() {
    return eventually([this] { return speed() > 0.2; });
  }
  bool comes_to_rest() {
    return eventually([this] { return speed() == 0.0; });
  }
  std::string logs() {
    return (daemon_ ? daemon_->output() : "") + "\n--- robot\n" + (robot_ ? robot_->output() : "");
  }

  Scene scene_;
  NotifySocket notify_{scene_.path("notify")};
  std::unique_ptr<Process> robot_, daemon_;
  double robot_started_s_ = 0.0;  ///< CLOCK_MONOTONIC at the zero of the simulator's time, or just before
  const Config defaults_;
};

}  // namespace heel::test
