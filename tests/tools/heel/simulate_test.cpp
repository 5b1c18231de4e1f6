// `heel simulate` with one scenario, several, and a folder.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "support/environment.h"
#include "support/figure.h"
#include "support/sanitized.h"
#include "support/test_data.h"
#include "tools/heel/run_heel.h"

namespace heel {
namespace {

using test::Outcome;
using test::run_heel;
using test::TemporaryFolder;
using test::write_text;
using ::testing::AllOf;
using ::testing::HasSubstr;

/// Two seconds with a small picture: about the time to connect.
std::string scenario_text(const std::string& name, const std::string& shirt) {
  return "name = \"" + name + "\"\nshows = \"what " + name +
         " is hard by\"\nduration_s = 2.0\n[person]\nshirt = \"" + shirt +
         "\"\nwalk_after_s = 0.0\n[[person.path]]\nstep = \"straight\"\nlength_m = 3\n[robot]\nx_m = -1.8\n"
         "[room]\nobjects = 3\n[camera]\nwidth_px = 320\nheight_px = 240\nfocal_px = [415.0, 415.0]\n"
         "centre_px = [161.0, 118.0]\n";
}

class Simulate : public ::testing::Test {
 protected:
  std::string scenario(const std::string& name, const std::string& shirt = "bold") {
    return write_text(folder_.file(name + ".toml"), scenario_text(name, shirt));
  }
  Outcome simulate(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "simulate");
    return run_heel(arguments);
  }
  TemporaryFolder folder_;
};

TEST_F(Simulate, OneScenarioGivesOneObject) {
  if (test::kThreadSanitizer) GTEST_SKIP() << "the lock-step tests run the same threads for a shorter time";
  const Outcome run = simulate({scenario("walk"), "--json", "--seed", "5"});
  ASSERT_EQ(run.status, 0) << run.err;
  const auto json = nlohmann::json::parse(run.out);
  EXPECT_EQ(json.at("scenario"), "walk");
  EXPECT_EQ(json.at("seed"), 5);
  EXPECT_GT(json.at("ticks"), 90);
  EXPECT_TRUE(json.contains("following_rms_m"));
}

TEST_F(Simulate, AFolderGivesATableAndPictures) {
  if (test::kThreadSanitizer) GTEST_SKIP() << "the lock-step tests run the same threads for a shorter time";
  scenario("a_walk");
  scenario("b_check", "fine_check");
  const std::string out = folder_.file("out");
  const Outcome run = simulate({folder_.path().string(), "-o", out});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(run.out, AllOf(HasSubstr("a_walk"), HasSubstr("what a_walk is hard by"),
                             HasSubstr("b_check              refused: ")));
  EXPECT_EQ(run.out.find(test::read_text(out + "/table.txt")), 0U);
  EXPECT_LT(run.out.find("a_walk"), run.out.find("b_check"));
  test::expect_figure(out + "/a_walk/path", {1200, 810});
  test::expect_figure(out + "/a_walk/errors", {1200, 1530});
  EXPECT_EQ(cv::imread(out + "/a_walk/frames.png").cols, 1620);
  EXPECT_EQ(cv::imread(out + "/overview.png").cols, 1650);
  const auto overview = nlohmann::json::parse(test::read_text(out + "/overview.json"));
  ASSERT_EQ(overview.size(), 2U);
  EXPECT_EQ(overview[0].at("shows"), "what a_walk is hard by");
  EXPECT_TRUE(overview[1].contains("refused"));
  EXPECT_TRUE(std::filesystem::exists(out + "/a_walk/truth.csv"));
  EXPECT_FALSE(std::filesystem::exists(out + "/b_check"));
}

TEST_F(Simulate, SeveralScenariosGiveAListAndAnUnmetLimitNamesItsScenario) {
  if (test::kThreadSanitizer) GTEST_SKIP() << "the lock-step tests run the same threads for a shorter time";
  const test::ScopedEnvironment plots("HEEL_PLOTS", "/bin/true");  // draws nothing
  const Outcome run =
      simulate({scenario("one"), scenario("two"), "--json", "--min-path-m", "50", "-o", folder_.file("out")});
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.err, AllOf(HasSubstr("heel simulate: one: the robot went"),
                             HasSubstr("heel simulate: two: the robot went")));
  const auto json = nlohmann::json::parse(run.out);
  ASSERT_EQ(json.size(), 2U);
  EXPECT_EQ(json[0].at("scenario"), "one");
  EXPECT_EQ(json[1].at("scenario"), "two");
}

// One run on each core at a time: each gives the same as it does alone, whichever ends first.
TEST_F(Simulate, ManyRunsWithoutPicturesDependOnlyOnTheirSeeds) {
  const std::string walk = scenario("walk"),
                    model = test::source_path("tools/heel-sim/pose_noise/pictured.toml");
  const Outcome many =
      simulate({walk, "--json", "--error-model", model, "--seed", "7", "--duration", "9", "--runs", "4"});
  ASSERT_EQ(many.status, 0) << many.err;
  std::vector<double> driven_m;
  for (const char* seed : {"7", "8", "9", "10"}) {
    const Outcome one = simulate({walk, "--json", "--error-model", model, "--seed", seed, "--duration", "9"});
    ASSERT_EQ(one.status, 0) << one.err;
    driven_m.push_back(nlohmann::json::parse(one.out)["robot_path_m"].get<double>());
  }
  const auto figures = nlohmann::json::parse(many.out);
  EXPECT_EQ(figures["runs"], 4);
  EXPECT_EQ(figures["simulated_s"], 36.0);
  EXPECT_NEAR(figures["robot_path_m"]["min"].get<double>(), *std::ranges::min_element(driven_m), 1e-9);
  EXPECT_NEAR(figures["robot_path_m"]["max"].get<double>(), *std::ranges::max_element(driven_m), 1e-9);
  EXPECT_LT(figures["robot_path_m"]["min"], figures["robot_path_m"]["max"]) << "seeds differ";
}

TEST_F(Simulate, BadInputIsNamedBeforeAnythingRuns) {
  const std::string good = scenario("good");
  std::filesystem::create_directory(folder_.file("empty"));
  const Outcome empty = simulate({folder_.file("empty")});
  EXPECT_EQ(empty.status, 2);
  EXPECT_THAT(empty.err, HasSubstr("empty: no scenario in this folder (expected *.toml)"));
  const Outcome twice = simulate({good, good});
  EXPECT_EQ(twice.status, 2);
  EXPECT_THAT(twice.err, HasSubstr("a second scenario called 'good'"));
  const std::string outside = write_text(folder_.file("outside.toml"), scenario_text("../outside", "bold"));
  const Outcome escaping = simulate({good, outside, "-o", folder_.file("out")});
  EXPECT_EQ(escaping.status, 2);
  EXPECT_THAT(escaping.err, HasSubstr("'../outside' cannot name a folder"));
  const Outcome absent = simulate({good, folder_.file("absent.toml")});
  EXPECT_EQ(absent.status, 2);
  EXPECT_THAT(absent.err, HasSubstr("absent.toml: cannot read"));
  for (const Outcome& run : {empty, twice, escaping, absent}) EXPECT_EQ(run.out, "");
}

}  // namespace
}  // namespace heel
