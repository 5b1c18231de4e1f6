// `heel tune`: what it finds, what it writes, and that it ends when it is told to.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/test_data.h"
#include "support/text.h"
#include "tools/heel/run_heel.h"

namespace heel {
namespace {

using test::Outcome;
using test::read_text;
using test::run_heel;
using test::write_text;
using ::testing::HasSubstr;
using ::testing::Not;

class Tune : public ::testing::Test {
 protected:
  std::vector<std::string> arguments(const std::vector<std::string>& more) const {
    std::vector<std::string> all{
        "tune",   scenario_, "--error-model", test::source_path("tools/heel-sim/pose_noise/pictured.toml"),
        "--runs", "1"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  Outcome tune(const std::vector<std::string>& more) const { return run_heel(arguments(more)); }
  std::string config(const std::string& text) const { return write_text(folder_.file("heel.toml"), text); }

  test::TemporaryFolder folder_;
  std::string scenario_ = write_text(folder_.file("walk.toml"),
                                     "name = \"walk\"\nduration_s = 14.0\n[person]\nwalk_after_s = 1.0\n"
                                     "[[person.path]]\nstep = \"straight\"\nlength_m = 5\n"
                                     "[robot]\nx_m = -1.8\n");
};

/// A gain of a fifth of the shipped one lags far behind.
constexpr const char* kSlow = "[control]\ngain_distance_1_s = 0.3  # cautious\n\n[gate]\nv_max_m_s = 0.7\n";

TEST_F(Tune, WritesBetterValuesInABlockAndSaysWhatTheyWereTunedOn) {
  const std::string file = config(kSlow);
  const Outcome run = tune(
      {"--config", file, "-o", file, "--key", "control.gain_distance_1_s", "--within", "5", "--steps", "10"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("control.gain_distance_1_s"));
  EXPECT_THAT(run.out, HasSubstr("written: " + file));
  const std::string text = read_text(file);
  EXPECT_THAT(text, HasSubstr("# (before heel tune) gain_distance_1_s = 0.3  # cautious\n# >>> heel tune\n"));
  EXPECT_THAT(text, HasSubstr("law view, scenarios walk"));
  EXPECT_THAT(text, HasSubstr("# <<< heel tune\n\n[gate]\nv_max_m_s = 0.7\n"));

  const Outcome with_it =
      run_heel({"simulate", scenario_, "--error-model",
                test::source_path("tools/heel-sim/pose_noise/pictured.toml"), "--config", file, "--json"});
  EXPECT_EQ(with_it.status, 0) << "heel reads what it has written: " << with_it.err;
}

TEST_F(Tune, JsonHasEveryStepAndTheFiguresOfSeedsThatWereNotSearched) {
  const Outcome run = tune({"--config", config(kSlow), "--key", "control.gain_distance_1_s", "--within", "5",
                            "--steps", "6", "--seed", "4", "--json"});
  ASSERT_EQ(run.status, 0) << run.err;
  const auto json = nlohmann::json::parse(run.out);
  EXPECT_EQ(json.at("steps").size(), 6U);
  EXPECT_EQ(json.at("steps")[0].at("values")[0], 0.3) << "it begins with the values that are in use";
  EXPECT_EQ(json.at("first_seed"), 4);
  EXPECT_NE(json.at("first_seed_aside"), 4);
  EXPECT_LT(json.at("cost_after"), json.at("cost_before"));
  EXPECT_GT(json.at("keys")[0].at("after"), 0.5);
  EXPECT_LT(json.at("scenarios")[0].at("after").at("along_p95_m"),
            json.at("scenarios")[0].at("before").at("along_p95_m"));
  EXPECT_EQ(read_text(folder_.file("heel.toml")), kSlow) << "nothing is written without -o";
}

TEST_F(Tune, NothingIsWrittenWhereNothingIsBetter) {
  const std::string file = config("[control]\ngain_distance_1_s = 1.0\n");
  const Outcome run = tune({"--config", file, "-o", file, "--key", "control.gain_distance_1_s", "--within",
                            "1.01", "--steps", "3"});
  EXPECT_EQ(run.status, 1);
  EXPECT_EQ(run.err, "heel tune: no better values found; nothing is written\n");
  EXPECT_EQ(read_text(file), "[control]\ngain_distance_1_s = 1.0\n");
}

bool catches_sigint(pid_t pid) {
  const std::string status = read_text("/proc/" + std::to_string(pid) + "/status");
  const std::size_t at = status.find("SigCgt:");
  return at != std::string::npos &&
         (std::stoull(status.substr(at + 7), nullptr, 16) >> (SIGINT - 1) & 1U) != 0;
}

TEST_F(Tune, CtrlCEndsTheSearchAndWhatItHasFoundIsJudged) {
  std::vector<std::string> argv = arguments({"--steps", "100000", "--json", "--config", config(kSlow)});
  argv.insert(argv.begin(), test::built_program("heel"));
  test::Process heel(argv);
  ASSERT_TRUE(test::eventually([&] { return catches_sigint(heel.pid()); }));
  heel.signal(SIGINT);
  EXPECT_GE(heel.wait(), 0) << "ended by itself";
  EXPECT_THAT(heel.output(), HasSubstr("\"interrupted\": true"));
}

TEST_F(Tune, WhatCannotBeTunedIsOneLine) {
  const Outcome key = tune({"--key", "gate.v_max_m_s"});
  EXPECT_EQ(key.status, 2);
  EXPECT_THAT(key.err, testing::StartsWith("heel tune: gate.v_max_m_s: cannot be tuned (expected one of "));
  const Outcome file = tune({"--config", config("[control]\ngain_yaw_1_s = fast\n")});
  EXPECT_EQ(file.status, 2);
  EXPECT_THAT(file.err, HasSubstr("heel.toml:2"));
  EXPECT_EQ(run_heel({"tune", scenario_}).status, 2) << "without an error model";
}

}  // namespace
}  // namespace heel
