// heel report: the figures of a synthetic run, calculated by hand; criteria; and runs that cannot be read.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "evaluation/reports/run_files.h"
#include "evaluation/reports/synthetic_run.h"
#include "support/environment.h"
#include "tools/heel/run_heel.h"

namespace heel {
namespace {

using test::Outcome;
using test::run_heel;
using test::TemporaryFolder;
using test::write_text;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

/// Draws nothing: figures_test.cpp tests the figures.
Outcome report(const TemporaryFolder& folder, const std::vector<std::string>& options = {}) {
  const test::ScopedEnvironment plots("HEEL_PLOTS", "/bin/true");
  std::vector<std::string> arguments{"report", folder.path().string()};
  arguments.insert(arguments.end(), options.begin(), options.end());
  return run_heel(arguments);
}

TEST(Report, GivesTheFiguresCalculatedByHand) {
  const TemporaryFolder folder;
  test::write_run(folder);
  const evaluation::FollowMetrics m = evaluation::read_run(folder.path().string()).evaluate();
  EXPECT_NEAR(m.t_walk_end_s - m.t_walk_begin_s, 8.0, 1e-9);
  EXPECT_NEAR(m.person_path_m, 4.0, 1e-6);
  // 79 steps of 0.05 m along x, and one that also goes 0.4 m sideways.
  EXPECT_NEAR(m.robot_path_m, 79 * 0.05 + std::hypot(0.05, 0.4), 1e-6);
  // While the person walks: 40 rows 0.3 m to the left, 41 rows 0.1 m to the right.
  EXPECT_EQ(m.lateral_m.count, 81U);
  EXPECT_NEAR(m.lateral_m.rms, std::sqrt((40 * 0.09 + 41 * 0.01) / 81), 1e-9);
  EXPECT_NEAR(m.lateral_m.highest, 0.3, 1e-9);
  EXPECT_NEAR(m.lateral_m.lowest, -0.1, 1e-9);
  EXPECT_NEAR(m.separation_m.lowest, std::hypot(2.0, 0.1), 1e-9);
  // Frames 20 … 99; five of them not found, three even and two odd ones.
  EXPECT_EQ(m.frames, 80U);
  EXPECT_EQ(m.frames_found, 75U);
  EXPECT_NEAR(m.out_of_view_longest_s, 0.6, 1e-6);  // frame 49 to frame 55
  EXPECT_NEAR(m.yaw_error_rad.mean, (37 * 0.1 - 38 * 0.06) / 75, 1e-6);
  EXPECT_NEAR(m.yaw_error_rad.rms, std::sqrt((37 * 0.01 + 38 * 0.0036) / 75), 1e-6);
  EXPECT_NEAR(m.yaw_nees, (37 * 1.0 + 38 * 0.36) / 75, 1e-6);
  EXPECT_NEAR(m.x_error_m.rms, 0.0, 1e-9);
  EXPECT_NEAR(m.z_error_m.mean, test::kZError_m, 1e-9);
}

TEST(Report, CountsStopsByReasonAndNotTheEndOfTheRun) {
  const TemporaryFolder folder;
  test::write_run(folder);
  const Outcome outcome = report(folder);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("stops                  1: target lost, 0.50 s at rest\n"));
  EXPECT_THAT(outcome.out, Not(HasSubstr("shutting down")));
}

TEST(Report, WritesTheSummaryAsTextAndAsJson) {
  const TemporaryFolder folder;
  test::write_run(folder);
  const Outcome outcome = report(folder, {"--json"});
  const auto json = nlohmann::json::parse(test::read_text(folder.file("summary.json")));
  EXPECT_EQ(nlohmann::json::parse(outcome.out), json);
  EXPECT_NEAR(json.at("following_rms_m").get<double>(), 0.2225, 1e-4);
  EXPECT_NEAR(json.at("following_max_m").get<double>(), 0.3, 1e-9);
  EXPECT_EQ(json.at("stops_by_reason"), nlohmann::json({{"target lost", 1}}));
  EXPECT_TRUE(json.at("failed").empty());
  EXPECT_THAT(test::read_text(folder.file("summary.txt")),
              AllOf(HasSubstr("person walked          4.00 m in 8.0 s\n"),
                    HasSubstr("beside the path        0.222 m RMS, 0.300 m at most\n"),
                    HasSubstr("target found           in 75 of 80 frames\n"),
                    HasSubstr("out of view            0.60 s at the longest\n"),
                    HasSubstr("yaw error              4.71 degrees RMS, mean +1.08\n")));
}

TEST(Report, EndsWithStatus1AndTheReasonWhereACriterionIsNotMet) {
  const TemporaryFolder folder;
  test::write_run(folder);
  EXPECT_EQ(
      report(folder, {"--max-out-of-view-s", "0.61", "--max-rms-m", "0.23", "--min-path-m", "4.3"}).status,
      0);
  struct Row {
    std::vector<std::string> options;
    std::string reason;
  };
  const std::vector<Row> rows = {
      {{"--max-out-of-view-s", "0.59"}, "the target was out of view for 0.60 s (at most 0.59 s allowed)"},
      {{"--max-rms-m", "0.22"}, "the robot's path was 0.222 m RMS beside the person's (at most 0.220 m"},
      {{"--min-path-m", "4.4"}, "the robot went 4.35 m (at least 4.40 m expected)"},
  };
  for (const Row& row : rows) {
    SCOPED_TRACE(row.options[0]);
    const Outcome outcome = report(folder, row.options);
    EXPECT_EQ(outcome.status, 1);
    EXPECT_THAT(outcome.err, StartsWith("heel report: " + row.reason));
    EXPECT_THAT(outcome.out, HasSubstr("FAILED                 " + row.reason));
  }
}

TEST(Report, ARunWithoutFramesHasFailed) {
  const TemporaryFolder folder;
  test::write_run(folder);
  test::record_run(folder, /*with_poses=*/false);
  const Outcome outcome = report(folder);
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.err, HasSubstr("no frame was seen while the person walked"));
}

TEST(Report, ReadsARunThatEndsInTheMiddleOfARecord) {
  const TemporaryFolder folder;
  test::write_run(folder);
  const std::string bytes = test::read_text(folder.file(test::kRunRecording));
  const std::size_t end = bytes.size() - 300;  // within the summary
  write_text(folder.file(test::kRunRecording), bytes.substr(0, end));
  const Outcome outcome = report(folder);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("in 75 of 80 frames"));
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  text.replace(text.find(from), from.size(), to);
  return text;
}

TEST(Report, RefusesBadRecordingsInOneLineThatNamesThePlace) {
  const std::string truth = test::truth_csv();
  struct Row {
    std::string file;
    std::string content;  ///< "": the file is not there
    std::string names;
  };
  const std::vector<Row> rows = {
      {"truth.csv", "", "truth.csv: cannot read (expected a CSV file with a header line)"},
      {test::kRunRecording, "", "no recording in this folder (expected a file *.mcap)"},
      {test::kRunRecording, "t_s,tick\n", "run.mcap: not an MCAP file (expected a recording of heeld"},
      {"truth.csv", std::string("\x7f\x45\x4c\x46\0\1\n\2\n", 9), "truth.csv: no column 't_s'"},
      {"truth.csv", replaced(truth, "person_speed_m_s", "speed"), "truth.csv: no column 'person_speed_m_s'"},
      {"truth.csv", replaced(truth, "\n0.1,1000.1,", "\n0.1,"), "truth.csv:3: 13 cells (expected 14"},
      {"truth.csv", replaced(truth, ",1000.2,", ",999.0,"), "truth.csv:4: t_monotonic_s goes back"},
  };
  for (const Row& row : rows) {
    SCOPED_TRACE(row.names);
    const TemporaryFolder folder;
    test::write_run(folder);
    if (row.content.empty())
      std::filesystem::remove(folder.file(row.file));
    else
      write_text(folder.file(row.file), row.content);
    const Outcome outcome = report(folder);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_THAT(outcome.err, AllOf(StartsWith("heel report: "), HasSubstr(row.names)));
    EXPECT_FALSE(std::filesystem::exists(folder.file("summary.txt")));
  }
}

}  // namespace
}  // namespace heel
