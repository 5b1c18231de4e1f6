// heel setup on heel-sim: from an empty folder to a followed walk; and nothing moves without consent.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "loopback/daemon/scene.h"
#include "support/process.h"
#include "support/temporary_folder.h"

namespace heel {
namespace {

using nlohmann::json;
using test::built_program;
using test::Outcome;
using test::Process;
using ::testing::HasSubstr;
using ::testing::Not;

/// A person who stands 1.72 m before the camera, then walks 6 m.
std::string scenario(int walk_after_s) {
  return "name = \"walks\"\nduration_s = 3600.0\n[person]\nshirt = \"bold\"\nwalk_after_s = " +
         std::to_string(walk_after_s) +
         "\n[[person.path]]\nstep = \"straight\"\nlength_m = 6\n[robot]\nx_m = -2.0\n";
}

class Setup : public ::testing::Test {
 protected:
  std::string file(const std::string& name) const { return folder_.file(name); }

  void start_world(int walk_after_s = 3000) {
    world_.reset();
    const std::vector<std::string> argv{built_program("heel-sim"),
                                        "--scenario",
                                        test::write_text(file("walks.toml"), scenario(walk_after_s)),
                                        "--robot",
                                        "pty:" + file("robot"),
                                        "--camera",
                                        camera_,
                                        "--camera-info-out",
                                        file("measured.yaml"),
                                        "--truth",
                                        file("truth.csv")};
    world_ = std::make_unique<Process>(argv, file("world.log"));
    ASSERT_TRUE(world_->says("ready at")) << world_->output();
  }

  std::vector<std::string> command(const std::vector<std::string>& more) const {
    std::vector<std::string> argv{built_program("heel"), "setup", "--config", file("heel.toml")};
    argv.insert(argv.end(), more.begin(), more.end());
    return argv;
  }
  /// The JSON lines.
  std::vector<json> set_up(const std::vector<std::string>& more, int status = 0) {
    const Outcome outcome = test::run_program(command(more));
    EXPECT_EQ(outcome.status, status) << outcome.out << outcome.err;
    std::vector<json> lines;
    std::istringstream text(outcome.out);
    for (std::string line; std::getline(text, line);) lines.push_back(json::parse(line));
    return lines;
  }
  /// With these lines typed.
  Outcome answered(const std::string& answers, const std::string& options) const {
    return test::run_program({"/bin/sh", "-c",
                              "printf '" + answers + "' | " + built_program("heel") + " setup --config " +
                                  file("heel.toml") + " " + options});
  }
  void configure_robot() const { test::write_text(file("heel.toml"), "[robot]\naddress = \"pty:robot\"\n"); }
  double newest_speed() const { return test::newest_truth(file("truth.csv")).v_m_s; }
  double fastest() const {
    double fastest_m_s = 0.0;
    for (const test::Truth& row : test::all_truth(file("truth.csv")))
      fastest_m_s = std::max(fastest_m_s, std::abs(row.v_m_s));
    return fastest_m_s;
  }
  /// How far the robot has driven.
  double way_m() const {
    double way_m = 0.0, t_s = 0.0;
    for (const test::Truth& row : test::all_truth(file("truth.csv"))) {
      way_m += row.v_m_s * (row.t_s - t_s);
      t_s = row.t_s;
    }
    return way_m;
  }

  test::TemporaryFolder folder_;
  std::string camera_ = "sim:" + folder_.path().filename().string();
  std::unique_ptr<Process> world_;
};

TEST_F(Setup, FromAnEmptyFolderToAFollowedWalk) {
  start_world();
  const std::vector<json> lines = set_up(
      {"--camera", camera_, "--camera-info", file("measured.yaml"), "--robot", "pty:" + file("robot"),
       "--distance", "1.72", "--height", "1.65", "--countdown", "0", "--reach-time", "1", "--yes", "--json"});
  ASSERT_EQ(lines.size(), 7U);
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_EQ(lines[i]["verdict"], lines[i]["step"] == "wheels" ? "skipped" : "pass") << lines[i];
  EXPECT_EQ(lines[6], (json{{"ready", true}, {"config", file("heel.toml")}}));
  EXPECT_NEAR(lines[4]["values"]["person"]["distance_m"], 1.72, 0.03);
  EXPECT_EQ(fastest(), 0.0);
  EXPECT_TRUE(std::filesystem::exists(file("setup-camera.png")));
  EXPECT_TRUE(std::filesystem::exists(file("setup-shirt.png")));

  const Outcome checked =
      test::run_program({built_program("heeld"), "--config", file("heel.toml"), "--check"});
  EXPECT_EQ(checked.status, 0) << checked.err;
  const Outcome preflight =
      test::run_program({built_program("heel"), "preflight", "--config", file("heel.toml")});
  EXPECT_EQ(preflight.status, 0) << preflight.out;

  start_world(20);
  test::write_text(file("heel.toml"),
                   test::read_text(file("heel.toml")) +
                       "[operator]\nsocket = \"control.sock\"\n[runtime]\nrealtime = false\n");
  Process heeld({built_program("heeld"), "--config", file("heel.toml")});
  // A start is refused until the first frames and the robot are there.
  EXPECT_TRUE(test::eventually([&] {
    test::run_program({built_program("heel"), "start", "--socket", file("control.sock")});
    return way_m() > 2.0;
  })) << heeld.output()
      << world_->output();
}

TEST_F(Setup, NothingMovesUnlessTheWordIsTyped) {
  start_world();
  configure_robot();
  for (const char* answers : {"yes\\nyes\\n", "y\\n", "\\n", ""}) {
    const Outcome outcome = answered(answers, "--step wheels");
    EXPECT_EQ(outcome.status, 0) << outcome.out;
    EXPECT_THAT(outcome.out, HasSubstr("nothing was moved"));
  }
  EXPECT_THAT(set_up({"--step", "wheels", "--yes", "--json"})[0]["verdict"], "skipped");
  EXPECT_EQ(fastest(), 0.0);
  const Outcome moved = answered("blocks\\nyes\\n", "--step wheels");
  EXPECT_EQ(moved.status, 0) << moved.out;
  EXPECT_THAT(moved.out, HasSubstr("pass"));
  EXPECT_GT(fastest(), 0.05);
  EXPECT_TRUE(test::eventually([&] { return newest_speed() == 0.0; }));
}

TEST_F(Setup, TheRobotMeasuresTheDistanceByDrivingBackWithConsent) {
  start_world();
  configure_robot();
  test::write_text(file("heel.toml"), test::read_text(file("heel.toml")) + "[camera]\nsource = \"" + camera_ +
                                          "\"\ninfo = \"measured.yaml\"\n");
  const std::string options = "--step shirt --height 1.65 --countdown 0 --reach-time 0";
  const Outcome refused = answered("drive\\n1.7\\nyes\\nyes\\nstop\\n", options);
  EXPECT_EQ(refused.status, 1) << refused.out;
  EXPECT_THAT(refused.out, HasSubstr("nothing was moved, so the distance is not known"));
  EXPECT_EQ(fastest(), 0.0);
  EXPECT_FALSE(std::filesystem::exists(file("shirt.heel")));

  const Outcome driven = answered("drive\\n1.7\\nyes\\nback\\n", options + " --json");
  EXPECT_EQ(driven.status, 0) << driven.out << driven.err;
  const json step = json::parse(driven.out.substr(0, driven.out.find('\n')), nullptr, false);
  EXPECT_NEAR(step["values"]["distance_m"], 1.72, 0.05) << driven.err;
  EXPECT_NEAR(step["values"]["person"]["distance_m"], 2.23, 0.1);
  EXPECT_NEAR(way_m(), -0.52, 0.1);
  EXPECT_TRUE(world_->says("closed")) << world_->output();
  EXPECT_TRUE(test::eventually([&] { return newest_speed() == 0.0; }));
}

/// The outline is on the wall, so the first drive measures nothing.
TEST_F(Setup, EachFurtherDriveIsAskedFor) {
  start_world();
  configure_robot();
  test::write_text(file("heel.toml"), test::read_text(file("heel.toml")) + "[camera]\nsource = \"" + camera_ +
                                          "\"\ninfo = \"measured.yaml\"\n");
  const Outcome outcome =
      answered("1.7\nagain\n1.7\n\nstop\n",
               "--step shirt --height 1.65 --countdown 0 --reach-time 0 --drive-back --roi 20,150,150,150");
  EXPECT_EQ(outcome.status, 1) << outcome.out;
  EXPECT_THAT(outcome.out, HasSubstr("type back"));
  EXPECT_THAT(outcome.out, HasSubstr("nothing was moved, so the distance is not known"));
  EXPECT_NEAR(way_m(), -0.52, 0.1) << outcome.out;
}

TEST_F(Setup, WheelsThatThePersonSawTurnOtherwiseFail) {
  start_world();
  configure_robot();
  const Outcome outcome = answered("blocks\\nno\\nstop\\n", "--step wheels");
  EXPECT_EQ(outcome.status, 1) << outcome.out;
  EXPECT_THAT(outcome.out, HasSubstr("exchange the connectors"));
}

TEST_F(Setup, AnInterruptWhileTheWheelsTurnStopsAndClosesTheRobot) {
  start_world();
  configure_robot();
  Process heel(command({"--step", "wheels", "--wheels-on-blocks", "--yes"}));
  ASSERT_TRUE(test::eventually([&] { return newest_speed() > 0.05; })) << heel.output();
  heel.signal(SIGINT);
  EXPECT_EQ(heel.wait(), 1) << heel.output();
  EXPECT_THAT(heel.output(), HasSubstr("Go on with:\n  heel setup --config"));
  EXPECT_TRUE(world_->says("closed")) << world_->output();
  EXPECT_TRUE(test::eventually([&] { return newest_speed() == 0.0; }));
  EXPECT_THAT(world_->output(), Not(HasSubstr("watchdog")));
}

TEST_F(Setup, ARobotThatDoesNotAnswerFailsItsStepAndChangesNothing) {
  configure_robot();
  const std::vector<json> lines =
      set_up({"--step", "robot", "--robot", "pty:" + file("nobody"), "--yes", "--json"}, 1);
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0]["verdict"], "fail");
  EXPECT_EQ(lines[1]["ready"], false);
  EXPECT_EQ(test::read_text(file("heel.toml")), "[robot]\naddress = \"pty:robot\"\n");
}

}  // namespace
}  // namespace heel
