// heel preflight on heel-sim: what passes, what fails and with which advice, and that nothing is left moving.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "loopback/daemon/scene.h"
#include "support/process.h"
#include "support/temporary_folder.h"
#include "support/text.h"

namespace heel {
namespace {

using nlohmann::json;
using test::built_program;
using test::Outcome;
using test::Process;
using ::testing::HasSubstr;

/// A person who stands 1.7 m before the camera.
constexpr const char* kStands =
    "name = \"stands\"\nduration_s = 3600.0\n[person]\nshirt = \"bold\"\nwalk_after_s = 3000.0\n"
    "[[person.path]]\nstep = \"straight\"\nlength_m = 5\n[robot]\nx_m = -2.0\n";

class Preflight : public ::testing::Test {
 protected:
  std::string file(const std::string& name) const { return folder_.file(name); }

  /// Another camera than the robot's, a pixel longer: its template is not turned with the robot's pictures.
  std::string taught_with() const {
    std::string text = test::read_text(file("camera.yaml"));
    text.replace(text.find("[554"), 4, "[555");
    return test::write_text(file("phone.yaml"), text);
  }

  void start_world(const std::vector<std::string>& more = {}) {
    std::vector<std::string> argv{built_program("heel-sim"),
                                  "--scenario",
                                  test::write_text(file("stands.toml"), kStands),
                                  "--robot",
                                  "pty:" + file("robot"),
                                  "--camera",
                                  camera_,
                                  "--still",
                                  file("shirt.png"),
                                  "--camera-info-out",
                                  file("camera.yaml"),
                                  "--truth",
                                  file("truth.csv")};
    argv.insert(argv.end(), more.begin(), more.end());
    world_ = std::make_unique<Process>(argv, file("world.log"));
    ASSERT_TRUE(world_->says("ready at")) << world_->output();
    const std::string log = world_->output();
    const std::size_t roi = log.find("roi=") + 4;
    const Outcome teach =
        test::run_program({built_program("heel"), "teach", "--image", file("shirt.png"), "--roi",
                           log.substr(roi, log.find(' ', roi) - roi), "--distance", "1.5", "--camera-info",
                           taught_with(), "--reach-time", "0", "-o", file("shirt.heel")});
    ASSERT_EQ(teach.status, 0) << teach.err;
  }

  std::vector<std::string> command(const std::vector<std::string>& more, const std::string& camera_keys) {
    const std::string config = test::write_text(
        file("heel.toml"), "[camera]\nsource = \"" + camera_ + "\"\ninfo = \"camera.yaml\"\n" + camera_keys +
                               "[target]\nshirt = \"shirt.heel\"\n[robot]\naddress = \"pty:robot\"\n");
    std::vector<std::string> argv{built_program("heel"), "preflight", "--config", config};
    argv.insert(argv.end(), more.begin(), more.end());
    return argv;
  }
  json preflight(std::vector<std::string> more, const std::string& camera_keys = "") {
    more.emplace_back("--json");
    const Outcome outcome = test::run_program(command(more, camera_keys));
    EXPECT_EQ(outcome.err, "");
    json answer = json::parse(outcome.out);
    EXPECT_EQ(outcome.status, answer.at("ready").get<bool>() ? 0 : 1) << answer;
    return answer;
  }
  /// Of the robot, as the simulator says.
  double newest_speed() const { return test::newest_truth(file("truth.csv")).v_m_s; }

  test::TemporaryFolder folder_;
  std::string camera_ = "sim:" + folder_.path().filename().string();
  std::unique_ptr<Process> world_;
};

TEST_F(Preflight, EverythingIsReadyAndTheRobotStandsStill) {
  start_world();
  const json answer = preflight({});
  ASSERT_EQ(answer["steps"].size(), 6U);
  for (const json& step : answer["steps"])
    EXPECT_EQ(step["verdict"], step["step"] == "wheels" ? "skipped" : "pass") << step;
  EXPECT_NEAR(answer["steps"][0]["values"]["rate_hz"], 30.0, 5.0);
  EXPECT_NEAR(answer["steps"][3]["values"]["distance_m"], 1.72, 0.05);
  EXPECT_EQ(answer["steps"][4]["values"]["front_sonars_heard"], 8);
  EXPECT_THAT(answer["steps"][4]["measured"].get<std::string>(), HasSubstr("p3at-sh"));
  const std::vector<test::Truth> truth = test::all_truth(file("truth.csv"));
  EXPECT_GT(truth.size(), 100U);
  for (const test::Truth& row : truth) ASSERT_EQ(row.v_m_s, 0.0);
}

TEST_F(Preflight, OnePictureHasNoPace) {
  start_world();
  camera_ = "file:" + file("shirt.png");
  const json step = preflight({"camera"})["steps"][0];
  EXPECT_EQ(step["verdict"], "fail") << step;
  EXPECT_THAT(step["advice"].get<std::string>(), HasSubstr("expected a video, or a folder of pictures"));
}

TEST_F(Preflight, CountsTheFrontSonarsThatTheModelHas) {
  start_world({"--model", "amigo-sh"});
  const json step = preflight({"robot"})["steps"][0];
  EXPECT_EQ(step["verdict"], "pass") << step;
  EXPECT_EQ(step["values"]["front_sonars"], 6);
  EXPECT_THAT(step["measured"].get<std::string>(), HasSubstr("6 of 6 front sonars"));
}

TEST_F(Preflight, WheelsTurnOnlyWhenTheyAreSaidToBeOnBlocks) {
  start_world();
  const json answer = preflight({"wheels", "--wheels-on-blocks"});
  EXPECT_TRUE(answer["ready"]) << answer;
  EXPECT_NEAR(answer["steps"][0]["values"]["forwards_m"], 0.15, 0.05);
  EXPECT_NEAR(answer["steps"][0]["values"]["left_rad"], 0.52, 0.15);
  EXPECT_TRUE(world_->says("closed")) << world_->output();
  EXPECT_TRUE(test::eventually([&] { return newest_speed() == 0.0; }));
}

TEST_F(Preflight, AnInterruptWhileTheWheelsTurnStopsAndClosesTheRobot) {
  start_world();
  Process heel(command({"wheels", "--wheels-on-blocks"}, ""));
  ASSERT_TRUE(test::eventually([&] { return newest_speed() > 0.05; })) << heel.output();
  heel.signal(SIGINT);
  EXPECT_EQ(heel.wait(), 1) << heel.output();
  EXPECT_THAT(heel.output(), HasSubstr("interrupted: the robot has been stopped"));
  EXPECT_TRUE(world_->says("closed")) << world_->output();
  EXPECT_TRUE(test::eventually([&] { return newest_speed() == 0.0; }));
  EXPECT_THAT(world_->output(), testing::Not(HasSubstr("watchdog")));
}

TEST_F(Preflight, APictureThatIsMountedOtherwiseIsNamedWithTheKeysToSet) {
  start_world();
  const json answer = preflight({"person"}, "mirror = true\n");
  EXPECT_EQ(answer["steps"][0]["verdict"], "fail");
  EXPECT_EQ(answer["steps"][0]["advice"], "set camera.rotate = 0 and camera.mirror = false");
}

TEST_F(Preflight, EachThingThatIsMissingFailsItsStep) {
  start_world();
  world_.reset();                          // no camera, no robot
  std::filesystem::remove(file("robot"));  // killed, it leaves a link to a pty that another test may get
  const json answer = preflight({});
  for (const json& step : answer["steps"]) {
    const bool needs_world = step["step"] == "camera" || step["step"] == "person" || step["step"] == "robot";
    if (!needs_world) continue;
    EXPECT_EQ(step["verdict"], "fail") << step;
    EXPECT_FALSE(step["advice"].get<std::string>().empty()) << step;
  }
  EXPECT_THAT(answer["steps"][4]["measured"].get<std::string>(), HasSubstr("No such file"));
}

TEST_F(Preflight, AStopButtonAndARobotThatHeeldHasAreNamed) {
  start_world({"--fault", "stop_button@0+3600"});
  EXPECT_THAT(preflight({"robot"})["steps"][0]["advice"].get<std::string>(), HasSubstr("stop button"));
  Process heeld({built_program("heeld"), "--config",
                 test::write_text(file("heeld.toml"), test::read_text(file("heel.toml")) +
                                                          "[operator]\nsocket = \"control.sock\"\n")});
  ASSERT_TRUE(heeld.says("robot synchronised")) << heeld.output();
  EXPECT_THAT(preflight({"robot"})["steps"][0]["measured"].get<std::string>(), HasSubstr("in use by heeld"));
}

TEST_F(Preflight, AWrongStepOrConfigurationIsBadUsage) {
  const Outcome step = test::run_program({built_program("heel"), "preflight", "--config", "x", "wings"});
  EXPECT_EQ(step.status, 2);
  EXPECT_THAT(step.err, HasSubstr("wings"));
  const Outcome config = test::run_program({built_program("heel"), "preflight", "--config", file("none")});
  EXPECT_EQ(config.status, 2);
  EXPECT_THAT(config.err, HasSubstr("none"));
}

}  // namespace
}  // namespace heel
