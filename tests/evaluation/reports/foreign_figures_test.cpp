// Figures and tables over a foreign set, from answers whose figures are worked out by hand.
#include "evaluation/reports/foreign_figures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "evaluation/reports/foreign_reliability.h"
#include "evaluation/reports/foreign_tables.h"
#include "files/csv_table.h"
#include "support/temporary_folder.h"

namespace heel {
namespace {

using evaluation::ForeignFigures;
using evaluation::ForeignSample;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

ForeignSample still(double true_deg, double error_deg, double sigma_deg, double certainty = 0.3) {
  ForeignSample s;
  s.method = "heel";
  s.image = "a.jpg";
  s.kind = "static";
  s.build = "avgman";
  s.print = "blobs";
  s.distance_m = 2.0;
  s.yaw_set_deg = s.yaw_back_deg = true_deg;
  s.found = true;
  s.certainty = certainty;
  s.yaw_deg = true_deg + error_deg;
  s.yaw_sigma_deg = sigma_deg;
  s.distance_ratio = 1.01;
  s.along_m = 0.03;
  s.across_m = 0.004;
  return s;
}

ForeignFigures figures(const std::vector<ForeignSample>& samples) {
  return evaluation::foreign_figures(evaluation::chosen(samples, [](const auto&) { return true; }));
}

TEST(ForeignFigures, CountWhatIsFoundSureWrongAndTurnedToTheOtherSide) {
  ForeignSample lost = still(20, 0, 1);
  lost.found = false;
  ForeignSample far = still(0, 1, 1);
  far.distance_ratio = 1.11;
  const ForeignFigures f = figures({still(20, 2, 1), still(-30, -16, 4), still(12, -13, 2, 0.07), far, lost});
  EXPECT_EQ(f.pictures, 5U);
  EXPECT_EQ(f.found, 4U);
  EXPECT_EQ(f.sure, 3U);
  EXPECT_EQ(f.wrong, 2U) << "by 16 degrees, and by a ninth of the distance";
  EXPECT_EQ(f.wrong_of_sure, 2U);
  EXPECT_EQ(f.turned, 3U);
  EXPECT_EQ(f.flips, 1U) << "12 degrees seen as -1";
  EXPECT_DOUBLE_EQ(f.yaw_mean_deg, 8.0);
  EXPECT_DOUBLE_EQ(f.yaw_median_deg, 7.5) << "between 2 and 13";
  EXPECT_DOUBLE_EQ(f.yaw_p95_deg, 13.0 + 0.85 * 3.0);
  EXPECT_DOUBLE_EQ(f.nees, (4.0 + 16.0 + 25.0 + 1.0) / 4.0) << "of 13 / 2, squared, no more than 25 counts";
  EXPECT_NEAR(f.along_rms_m, 0.03, 1e-12);
}

TEST(ForeignFigures, JudgeTheStatedSigmaInThirdsOfIt) {
  std::vector<ForeignSample> samples;
  for (const double sigma_deg : {3.0, 1.0, 2.0})
    for (int i = 0; i < 3; ++i) samples.push_back(still(0, 2, sigma_deg));
  EXPECT_THAT(figures(samples).nees_of_thirds, ElementsAre(4.0, 1.0, ::testing::DoubleEq(4.0 / 9.0)));
  samples.pop_back();
  EXPECT_TRUE(figures(samples).nees_of_thirds.empty()) << "too few";
}

TEST(ForeignFigures, GroupByDistanceAngleKindPrintAndBuild) {
  ForeignSample far = still(15, 1, 1), steep = still(60, 1, 1), board = still(0, 0, 1);
  far.distance_m = 4.0;
  board.kind = "board";
  board.build = "board";
  std::vector<std::string> names;
  std::vector<std::size_t> pictures;
  for (const auto& group : evaluation::foreign_groups({still(10, 1, 1), far, steep, board})) {
    names.push_back(group.name);
    pictures.push_back(group.figures.pictures);
  }
  EXPECT_THAT(names, ElementsAre("stills, 1-3 m, up to 45", "stills, 4 m, up to 30", "stills, 1-3 m, 60",
                                 "static", "board", "print blobs", "build avgman"));
  EXPECT_THAT(pictures, ElementsAre(1U, 1U, 1U, 3U, 1U, 3U, 3U)) << "a board is no person";
}

TEST(ForeignFigures, OfAWalkShowHowTheErrorChangesAndWhereItGoes) {
  std::vector<ForeignSample> walk;
  for (int i = 0; i < 40; ++i) {
    ForeignSample s = still(0, i % 2 == 0 ? 3.0 : -3.0, 1);
    s.kind = "walk";
    s.yaw_walk_deg = -1.0;
    walk.push_back(s);
  }
  const auto figures = evaluation::walk_figures(walk);
  ASSERT_TRUE(figures);
  EXPECT_DOUBLE_EQ(figures->change_deg, 6.0);
  EXPECT_DOUBLE_EQ(figures->direction_deg, std::sqrt((16.0 + 4.0) / 2.0));
  EXPECT_NEAR(figures->stride_direction_deg, 1.0, 0.2) << "the swing is gone, the path stays";
  walk.resize(17);
  EXPECT_FALSE(evaluation::walk_figures(walk)) << "hardly one pair of strides";
}

TEST(ForeignReliability, SortsPosesByWhatTheyState) {
  std::vector<evaluation::StatedPose> poses;
  for (int i = 0; i < 10; ++i) poses.push_back({0.12, 1.0, 1.0, i < 8});
  for (int i = 0; i < 10; ++i) poses.push_back({0.7, 4.0, 3.0, true});
  const auto certainty = evaluation::certainty_bins(poses);
  ASSERT_EQ(certainty.size(), 2U);
  EXPECT_EQ(certainty[0].found, 10U);
  EXPECT_EQ(certainty[0].right, 8U);
  EXPECT_NEAR(certainty[0].mean, 0.12, 1e-12);
  EXPECT_EQ(certainty[1].right, 10U);
  const auto sigma = evaluation::sigma_bins(poses);
  ASSERT_EQ(sigma.size(), 4U);
  EXPECT_DOUBLE_EQ(sigma.front().sigma_deg, 1.0);
  EXPECT_DOUBLE_EQ(sigma.front().error_deg, 1.0);
  EXPECT_DOUBLE_EQ(sigma.back().sigma_deg, 3.0);
  EXPECT_DOUBLE_EQ(sigma.back().error_deg, 4.0);
}

TEST(ForeignTables, SetMarkersBesideHeelInTheSameScenesOnly) {
  ForeignSample other = still(20, 9, 1), doubtful = still(20, 3, 1, 0.07);
  other.image = "not among the markers.jpg";
  doubtful.image = "b.jpg";
  const std::vector<evaluation::MarkerSample> markers = {{"ArUco", "a.jpg", 2.0, 20.0, 20.0, true, 24.0},
                                                         {"ArUco", "b.jpg", 2.0, 20.0, 20.0, false, NAN}};
  const std::string table = evaluation::marker_table(markers, {still(20, 1, 1), doubtful, other});
  EXPECT_THAT(table,
              AllOf(HasSubstr("| 1 to 3 m, below 50° | ArUco | 2 | 50 % | 4.0 / 4.0 / 4.0° | 0 of 1 |"),
                    HasSubstr("| 1 to 3 m, below 50° | heel | 2 | 50 % | 2.0 / 2.0 / 2.9° | 0 of 2 |")));
  EXPECT_THAT(table, Not(HasSubstr("4 m")));
}

TEST(ForeignTables, SayNothingOfWhatWasNotFoundOrNotStated) {
  ForeignSample lost = still(0, 0, 1);
  lost.found = false;
  EXPECT_THAT(evaluation::foreign_score_table({lost}),
              HasSubstr("| stills, 1-3 m, up to 45 | 1 | 0 | 0 | 0 | 0 | - | - | - | - | - | - | - | - |"));
  EXPECT_THAT(
      evaluation::foreign_score_table({still(10, 2, NAN)}),
      HasSubstr("| stills, 1-3 m, up to 45 | 1 | 1 | 1 | 0 | 0 | 2 | 2 | 2 | 0 | - | 0.03 | 0.004 | 0.3 |"));
}

}  // namespace
}  // namespace heel
