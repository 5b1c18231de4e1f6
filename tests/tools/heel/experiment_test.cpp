// heel experiment, heel simulate and heel report together: the paper's figures.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "support/figure.h"
#include "support/test_data.h"
#include "tools/heel/run_heel.h"

namespace heel {
namespace {

using test::Outcome;
using test::run_heel;
using test::TemporaryFolder;
using ::testing::HasSubstr;

class Experiments : public ::testing::Test {
 protected:
  void expect_done(const std::vector<std::string>& arguments) {
    const Outcome outcome = run_heel(arguments);
    ASSERT_EQ(outcome.status, 0) << arguments[0] << ": " << outcome.err;
  }
  /// A run without pictures; it takes less than a second.
  void simulate(const std::string& experiment, const std::string& name, std::vector<std::string> more = {}) {
    const std::string scenarios = test::source_path("tools/heel-sim/experiments/");
    std::vector<std::string> arguments{"simulate", scenarios + experiment + ".toml", "--duration", "12",
                                       "--out",    folder_.file("runs/" + name)};
    arguments.insert(arguments.end(),
                     {"--error-model", test::source_path("tools/heel-sim/pose_noise/pictured.toml")});
    arguments.insert(arguments.end(), more.begin(), more.end());
    expect_done(arguments);
  }
  /// Copies the rows of one kind of experiment as rows of every kind, because all of them would take long.
  void gather_errors() {
    std::string all;
    for (const char* name : {"lateral", "distance", "yaw"}) {
      const std::string rows = test::read_text(folder_.file(std::string(name) + ".csv"));
      all += all.empty() ? rows : rows.substr(rows.find('\n') + 1);
    }
    test::write_text(folder_.file("errors.csv"), all);
  }

  TemporaryFolder folder_;
};

TEST_F(Experiments, GiveTheFiguresOfThePaperAndOthers) {
  const std::string out = folder_.path().string();
  expect_done({"experiment", "lateral", "distance", "yaw", "hard", "--repeats", "1", "-o", out});
  simulate("response", "response");
  simulate("walk", "walk");
  simulate("walk", "walk-position-only",
           {"--config", test::source_path("tools/heel-sim/experiments/position-only.toml")});
  gather_errors();
  test::write_text(folder_.file("real_video.csv"),
                   "frame,in_view,found,certainty\n0,0,0,0.0\n3,1,1,0.5\n6,1,1,0.6\n9,0,0,0.0\n");
  const Outcome outcome = run_heel({"report", out});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(outcome.out, test::read_text(folder_.file("summary.md")));

  for (const char* name : {"fig2_t_x", "fig3_t_z", "fig4_yaw", "fig5_yaw_over_x", "fig6_yaw_over_z"})
    test::expect_figure(folder_.file(name), {1200, 870});
  test::expect_figure(folder_.file("fig7_response"), {1200, 1020});
  test::expect_figure(folder_.file("fig8_walk"), {1200, 840});
  test::expect_figure(folder_.file("errors_map"), {1440, 750});
  test::expect_figure(folder_.file("errors_over_conditions"), {1470, 630});  // two conditions
  test::expect_figure(folder_.file("real_video"), {1200, 420});
  const cv::Mat hard = cv::imread(folder_.file("fig1_hard.jpg"));
  EXPECT_EQ(hard.cols, 1290);
  EXPECT_GT(test::count_of(hard, 0x2be34a), 1000) << "the recovered quadrilaterals";
  for (const char* name : {"fig1_hard.jpg", "fig2_t_x.png", "fig7_response.png", "errors_map.png"})
    EXPECT_THAT(outcome.out, HasSubstr("](" + std::string(name) + ")"));
}

TEST_F(Experiments, AMissingPictureOfAHardCaseIsNamed) {
  expect_done({"experiment", "hard", "-o", folder_.path().string()});
  std::filesystem::remove(folder_.file("hard/003.png"));
  const Outcome outcome = run_heel({"report", folder_.path().string()});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.err, "heel report: " + folder_.file("hard/003.png") +
                             ": cannot read (expected the picture of " + folder_.file("hard.csv") + ":9)\n");
}

}  // namespace
}  // namespace heel
