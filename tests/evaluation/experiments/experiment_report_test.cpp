// Numbers and tables of experiments, from rows whose figures were calculated by hand.
#include "evaluation/reports/experiment_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/angles.h"
#include "evaluation/experiments/still_image_file.h"
#include "evaluation/reports/error_statistics.h"
#include "evaluation/reports/fit_rows.h"
#include "evaluation/reports/paper_comparison.h"
#include "evaluation/reports/paper_numbers.h"
#include "evaluation/reports/run_table.h"
#include "files/csv_table.h"
#include "support/temporary_folder.h"

namespace heel {
namespace {

using evaluation::StillImageRow;
using evaluation::StillSample;
using test::TemporaryFolder;
using ::testing::HasSubstr;

StillImageRow row_at(double x_m, double z_m, double yaw_rad, double yaw_error_rad, double certainty = 0.3) {
  StillImageRow row;
  row.name = "made up";
  row.view = {.x_m = x_m, .z_m = z_m, .yaw_rad = yaw_rad};
  row.true_x_m = x_m;
  row.true_z_m = z_m;
  row.true_yaw_rad = yaw_rad;
  row.pose.reason = PoseReason::Found;
  row.pose.certainty = certainty;
  row.pose.yaw_rad = yaw_rad + yaw_error_rad;
  row.pose.yaw_sigma_rad = 0.05;
  row.pose.position_m = {x_m + 0.01, 0.0, z_m - 0.02};
  row.t_sigma_m = {0.1, 0.1, 0.1};
  return row;
}

std::vector<StillSample> written_and_read(const std::vector<StillImageRow>& rows) {
  const TemporaryFolder folder;
  evaluation::write_still_images(rows, folder.file("rows.csv"));
  return evaluation::read_stills(folder.file("rows.csv"));
}

TEST(StillSamples, AreReadBackEqual) {
  StillImageRow lost = row_at(0.1, 2.0, 0.5, 0.0);
  lost.pose.reason = PoseReason::TooFewInliers;
  lost.world = {3, "mosaic", 0.25};
  lost.view.blur_px = 2.5;
  const auto samples = written_and_read({row_at(-0.4, 1.5, 0.3, 0.02), lost});
  ASSERT_EQ(samples.size(), 2U);
  EXPECT_TRUE(samples[0].found);
  EXPECT_NEAR(samples[0].yaw_error_rad(), 0.02, 1e-6);
  EXPECT_NEAR(samples[0].x_est_m - samples[0].true_x_m, 0.01, 1e-6);
  EXPECT_TRUE(samples[0].undisturbed());
  EXPECT_FALSE(samples[1].found);
  EXPECT_EQ(samples[1].certainty, 0.0) << "a target that is not found has certainty 0";
  EXPECT_EQ(samples[1].shirt, "mosaic");
  EXPECT_FALSE(samples[1].undisturbed());
}

TEST(StillSamples, FlippedAndWrong) {
  const double bearing_rad = std::atan2(0.4, 2.0);
  // The true yaw is 20° to one side of the line of sight, the estimate 20° to the other.
  const auto samples = written_and_read(
      {row_at(0.4, 2.0, bearing_rad + 0.35, -0.70), row_at(0.4, 2.0, bearing_rad + 0.35, -0.30),
       row_at(0.4, 2.0, bearing_rad + 0.05, -0.10), row_at(0.4, 2.0, bearing_rad + 0.35, 0.10)});
  EXPECT_TRUE(samples[0].flipped());
  EXPECT_TRUE(samples[0].wrong());
  EXPECT_FALSE(samples[1].flipped()) << "the estimate is on the true side";
  EXPECT_TRUE(samples[1].wrong()) << "17 degrees";
  EXPECT_FALSE(samples[2].flipped()) << "nearly frontal: the sign means nothing";
  EXPECT_FALSE(samples[3].wrong());
}

TEST(PaperComparison, MeanDeviationAndCertaintyOfEachCommandedValue) {
  StillImageRow lost = row_at(0.0, 1.0, 0.2, 0.0);
  lost.pose.reason = PoseReason::TooFewMatches;
  const auto steps = evaluation::steps_of(
      written_and_read({row_at(0.0, 1.0, 0.2, 0.01, 0.4), row_at(0.0, 1.0, 0.2, 0.03, 0.2), lost,
                        row_at(0.0, 1.0, -0.2, 0.0, 0.6)}),
      &StillSample::yaw_rad, &StillSample::yaw_est_rad, &StillSample::true_yaw_rad, 100.0);
  ASSERT_EQ(steps.size(), 2U);
  EXPECT_NEAR(steps[0].at, -20.0, 1e-9);
  EXPECT_EQ(steps[1].pictures, 3U);
  EXPECT_EQ(steps[1].found, 2U);
  EXPECT_NEAR(steps[1].mean, 22.0, 1e-6);
  EXPECT_NEAR(steps[1].deviation, 1.0, 1e-6);
  EXPECT_NEAR(steps[1].mean_abs_error, 2.0, 1e-6);
  EXPECT_NEAR(steps[1].certainty_mean, 0.2, 1e-6);
}

TEST(ErrorStatistics, BinsCountTheirOwnSamples) {
  const auto samples = written_and_read(
      {row_at(0, 2, 0.5, 0.1), row_at(0, 2, 0.5, -0.1), row_at(0, 2, 0.5, -1.0), row_at(0, 4, 0.5, 0.0)});
  const evaluation::ErrorBin bin =
      evaluation::error_bin("near", 2.0, samples, [](const StillSample& s) { return s.true_z_m < 3.0; });
  EXPECT_EQ(bin.found, 3U);
  EXPECT_EQ(bin.flips, 1U);
  EXPECT_EQ(bin.wrong, 1U);
  EXPECT_NEAR(bin.yaw_mean_rad, -1.0 / 3.0, 1e-6);
  EXPECT_NEAR(bin.yaw_nees, (4.0 + 4.0 + 400.0) / 3.0, 1e-3);
}

TEST(ErrorStatistics, TheBandOfExpectedDeviationsNarrowsWithTheNumber) {
  // chi-squared with 100 degrees of freedom: 2.5 % at 74.22, 97.5 % at 129.56.
  EXPECT_NEAR(evaluation::nees_band(100).low, 0.7422, 0.001);
  EXPECT_NEAR(evaluation::nees_band(100).high, 1.2956, 0.001);
}

TEST(PaperComparison, RSquaredAndMonotony) {
  EXPECT_NEAR(evaluation::r_squared({0, 1, 2, 3}, {1, 3, 5, 7}), 1.0, 1e-12);
  EXPECT_NEAR(evaluation::r_squared({0, 1, 2}, {0, 1, 0}), 0.0, 1e-12);
  std::vector<evaluation::Step> steps(4);
  for (std::size_t i = 0; i < 4; ++i) {
    steps[i].at = static_cast<double>(i);
    steps[i].mean = static_cast<double>(i);
    steps[i].pictures = steps[i].found = 10;
  }
  EXPECT_EQ(evaluation::breaks_of_monotony(steps, "m"), "");
  steps[2].mean = 0.5;
  EXPECT_THAT(evaluation::breaks_of_monotony(steps, "m"), HasSubstr("falls from 1 to 2 m"));
  steps[2].found = 4;
  EXPECT_THAT(evaluation::breaks_of_monotony(steps, "m"),
              HasSubstr("found in fewer than half of the pictures at 2 m"));
}

TEST(ExperimentReport, WritesTheNumbersOfTheGivenRowsAndTheirQuality) {
  const TemporaryFolder folder;
  const std::string directory = folder.path().string();
  EXPECT_FALSE(evaluation::holds_experiments(directory));
  std::vector<StillImageRow> lateral, yaw;
  for (int i = -4; i <= 4; ++i) lateral.push_back(row_at(0.2 * i, 2.0, 0.0, 0.01));
  for (int i = -3; i <= 3; ++i) yaw.push_back(row_at(0.0, 2.0, 0.3 * i, i == 3 ? -0.5 : 0.0));
  evaluation::write_still_images(lateral, folder.file("lateral.csv"));
  evaluation::write_still_images(yaw, folder.file("yaw.csv"));
  ASSERT_TRUE(evaluation::holds_experiments(directory));
  const std::string summary = evaluation::report_experiments(directory);
  EXPECT_THAT(summary, HasSubstr("R2 1.00000 | yes"));
  EXPECT_THAT(summary, HasSubstr("wrong above 0.1: 6.2 % of 16"));
  for (const char* name : {"fig2_t_x", "fig4_yaw", "fig5_yaw_over_x"}) {
    EXPECT_TRUE(std::filesystem::exists(folder.file(std::string(name) + ".csv"))) << name;
    EXPECT_THAT(summary, HasSubstr("](" + std::string(name) + ".png)"));
  }
  EXPECT_FALSE(std::filesystem::exists(folder.file("fig3_t_z.csv"))) << "there are no rows of this kind";
  const CsvTable steps(folder.file("fig5_yaw_over_x.csv"));
  ASSERT_EQ(steps.rows(), 9U);
  EXPECT_NEAR(steps.number(8, "commanded"), 0.8, 1e-9);
  EXPECT_EQ(steps.number(8, "found"), 1.0);
  EXPECT_NEAR(steps.number(8, "mean_deg"), kDegPerRad * 0.01, 1e-3);
}

TEST(FitRows, HoldConditionsAndErrorsOfTheFramesInView) {
  const double bearing_rad = std::atan2(0.4, 2.0);
  StillImageRow lost = row_at(0.4, 2.0, 0.0, 0.0);
  lost.pose.reason = PoseReason::TooFewMatches;
  StillImageRow after_lost = row_at(0.4, 2.0, bearing_rad + 0.35, -0.70);
  after_lost.picture = 1;
  after_lost.world.shirt = "mosaic";
  StillImageRow seen = row_at(0.4, 2.0, 0.0, 0.02), tracked = seen;
  tracked.picture = 1;
  CameraModel camera{.width_px = 640, .height_px = 480, .fx = 554, .fy = 554, .cx = 320, .cy = 240};
  const auto rows = evaluation::still_fit_rows(written_and_read({lost, after_lost, seen, tracked}), camera);
  ASSERT_EQ(rows.size(), 4U);
  EXPECT_FALSE(rows[0].found);
  EXPECT_TRUE(rows[1].conditions.whole_frame_search) << "the target was not in the picture before";
  EXPECT_TRUE(rows[1].flipped);
  EXPECT_TRUE(rows[1].conditions.other_print);
  EXPECT_FALSE(rows[3].conditions.whole_frame_search);
  EXPECT_FALSE(rows[3].flipped);
  EXPECT_NEAR(rows[3].conditions.aspect_rad, -bearing_rad, 1e-6);
  const double bearing_error_rad = std::atan2(0.41, 1.98) - bearing_rad;
  EXPECT_NEAR(rows[3].bearing_error_rad, bearing_error_rad, 1e-6);
  EXPECT_NEAR(rows[3].aspect_error_rad, 0.02 - bearing_error_rad, 1e-6);
  EXPECT_NEAR(rows[3].range_error_share, std::hypot(0.41, 1.98) / std::hypot(0.4, 2.0) - 1.0, 1e-6);
}

TEST(RunTable, CountsLossesAndTheirDuration) {
  evaluation::MetricsCollector run;
  for (int i = 0; i <= 100; ++i) {
    evaluation::MotionSample sample;
    sample.t_s = 0.1 * i;
    sample.has_person = true;
    sample.person = {0.05 * i, 0.0, 0.0};
    sample.robot = {0.05 * i - 2.0, 0.0, 0.0};
    sample.person_speed_m_s = 0.5;
    sample.back_in_view = i < 40 || i > 44;
    run.add(sample);
    evaluation::PoseSample pose;
    pose.t_s = 0.1 * i;
    pose.found = (i < 40 || i > 46) && i != 70;
    pose.has_truth = pose.found;
    pose.true_z_m = pose.z_m = 2.0;
    pose.yaw_rad = i == 80 ? 0.5 : 0.0;
    run.add(pose);
  }
  const evaluation::RunLine line = evaluation::run_line("made up", run);
  EXPECT_EQ(line.frames, 101U);
  EXPECT_EQ(line.found, 93U);
  EXPECT_EQ(line.visible, 96U);
  EXPECT_EQ(line.wrong, 1U);
  ASSERT_EQ(line.gaps_s.size(), 2U);
  EXPECT_NEAR(line.gaps_s[0], 0.8, 1e-9);
  EXPECT_NEAR(line.gaps_s[1], 0.2, 1e-9);
  EXPECT_THAT(evaluation::run_table({line}), HasSubstr("| 2 | 0.50 s, 0.80 s |"));
  EXPECT_EQ(evaluation::worlds_table({line}, {}), "");
  EXPECT_THAT(evaluation::worlds_table({line}, {line}),
              HasSubstr("| made up | 0.000, 0.000 m | 2.00, 2.00 m |"));
}

TEST(ErrorStatistics, BinsHaveUnitAndMiddleAndCellsHaveBounds) {
  const TemporaryFolder folder;
  // Straight ahead, 10.3° to the line of sight.
  const auto samples = written_and_read({row_at(0, 1.6, 0.18, 0.02), row_at(0, 1.7, 0.18, 0.04),
                                         row_at(0, 2.1, 0.18, -0.03), row_at(0, 2.1, -1.0, 0.0)});
  evaluation::write_errors(evaluation::error_curves(samples), folder.file("curves.csv"));
  const CsvTable curves(folder.file("curves.csv"));
  EXPECT_EQ(curves.text(0, "condition"), "distance");
  EXPECT_EQ(curves.text(0, "unit"), "m");
  EXPECT_EQ(curves.text(0, "bin"), "1.5 ... 2 m");
  EXPECT_NEAR(curves.number(0, "middle"), 1.75, 1e-9);
  EXPECT_EQ(curves.number(0, "pictures"), 2.0);
  EXPECT_NEAR(curves.number(0, "yaw_mean_deg"), kDegPerRad * 0.03, 1e-3);

  evaluation::write_error_map(samples, folder.file("map.csv"));
  const CsvTable map(folder.file("map.csv"));
  ASSERT_EQ(map.rows(), 9U * 10U);
  const std::size_t cell = 1 * 10 + 5;
  EXPECT_NEAR(map.number(cell, "distance_from_m"), 1.5, 1e-9);
  EXPECT_NEAR(map.number(cell, "distance_to_m"), 2.0, 1e-9);
  EXPECT_EQ(map.number(cell, "angle_from_deg"), 0.0);
  EXPECT_EQ(map.number(cell, "angle_to_deg"), 15.0);
  EXPECT_EQ(map.number(cell, "found"), 2.0);
  EXPECT_NEAR(map.number(cell, "yaw_mean_abs_deg"), kDegPerRad * 0.03, 1e-3);
  double pictures = 0;
  for (std::size_t i = 0; i < map.rows(); ++i) pictures += map.number(i, "pictures");
  EXPECT_EQ(pictures, 4.0);
}

/// A person walks along x at 0.5 m/s; a robot drives beside this line with a constant heading.
evaluation::MetricsCollector straight_run(double beside_m, double heading_rad) {
  evaluation::MetricsCollector run;
  for (int i = 0; i <= 40; ++i) {
    evaluation::MotionSample sample;
    sample.t_s = 0.1 * i;
    sample.has_person = true;
    sample.person = {0.05 * i, 0.0, 0.0};
    sample.person_speed_m_s = 0.5;
    sample.robot = {0.05 * i - 2.0, beside_m, heading_rad};
    run.add(sample);
  }
  return run;
}

TEST(PaperNumbers, TheResponseIsMeasuredFromThePersonsPath) {
  const TemporaryFolder folder;
  evaluation::write_response(folder.path().string(), straight_run(0.6, -0.5));
  const CsvTable rows(folder.file("fig7_response.csv"));
  ASSERT_EQ(rows.rows(), 41U);
  EXPECT_EQ(rows.number(0, "driven_m"), 0.0);
  EXPECT_NEAR(rows.number(40, "driven_m"), 2.0, 1e-6);
  EXPECT_NEAR(rows.number(40, "offset_m"), 0.6, 1e-9);
  EXPECT_NEAR(rows.number(40, "heading_deg"), kDegPerRad * -0.5, 1e-3);
  EXPECT_NEAR(rows.number(40, "person_x_m"), 2.0, 1e-9);
}

TEST(PaperNumbers, TheRunIsComparedWithOneThatFollowsThePositionOnly) {
  const TemporaryFolder folder;
  const auto run = straight_run(0.1, 0.0), position_only = straight_run(0.3, 0.0);
  const auto json = [&] { return nlohmann::json::parse(test::read_text(folder.file("fig8_walk.json"))); };
  evaluation::write_walk(folder.path().string(), run, nullptr);
  EXPECT_EQ(CsvTable(folder.file("fig8_walk.csv")).rows(), 41U);
  EXPECT_FALSE(json().contains("position_only_rms_m"));
  evaluation::write_walk(folder.path().string(), run, &position_only);
  const CsvTable rows(folder.file("fig8_walk.csv"));
  ASSERT_EQ(rows.rows(), 82U);
  EXPECT_EQ(rows.text(40, "run"), "walk");
  EXPECT_EQ(rows.text(41, "run"), "walk-position-only");
  EXPECT_NEAR(rows.number(41, "robot_y_m"), 0.3, 1e-9);
  EXPECT_NEAR(json().at("person_path_m").get<double>(), 2.0, 1e-9);
  EXPECT_NEAR(json().at("following_rms_m").get<double>(), 0.1, 1e-9);
  EXPECT_NEAR(json().at("position_only_rms_m").get<double>(), 0.3, 1e-9);
}

}  // namespace
}  // namespace heel
