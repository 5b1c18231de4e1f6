// heel experiment, heel simulate and heel report together: the paper's figures, and those on pictures of
// others.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "files/camera_info.h"
#include "files/csv_table.h"
#include "support/figure.h"
#include "support/sanitized.h"
#include "support/test_data.h"
#include "tools/heel/printed_shirt.h"
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
  expect_done({"experiment", "lateral", "distance", "yaw", "--repeats", "1", "-o", out});
  if (!test::kSanitized) expect_done({"experiment", "hard", "-o", out});  // the same code, for a minute
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
  for (const char* name : {"fig2_t_x.png", "fig7_response.png", "errors_map.png"})
    EXPECT_THAT(outcome.out, HasSubstr("](" + std::string(name) + ")"));
  if (test::kSanitized) return;
  const cv::Mat hard = cv::imread(folder_.file("fig1_hard.jpg"));
  EXPECT_EQ(hard.cols, 1290);
  EXPECT_GT(test::count_of(hard, 0x2be34a), 1000) << "the recovered quadrilaterals";
  EXPECT_THAT(outcome.out, HasSubstr("](fig1_hard.jpg)"));

  // Here, because the hard cases take long to make.
  std::filesystem::remove(folder_.file("hard/003.png"));
  const Outcome without = run_heel({"report", out});
  EXPECT_EQ(without.status, 2);
  EXPECT_EQ(without.err, "heel report: " + folder_.file("hard/003.png") +
                             ": cannot read (expected the picture of " + folder_.file("hard.csv") + ":9)\n");
}

/// A foreign set of a printed wall: a taught picture, three stills, twenty frames of a walk, and a print that
/// is too plain to be taught.
class ForeignSet : public Experiments {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(set_ + "/images");
    write_camera_model(test::shirt_camera(), set_ + "/camera.yaml");
    truth_ =
        "image,kind,build,print,pose,room,t_s,distance_m,yaw_set_deg,yaw_back_deg,yaw_walk_deg,"
        "back_fit_rms_depth_mm,centre_x_m,centre_y_m,centre_z_m,roi_x,roi_y,roi_w,roi_h,teach_distance_m\n";
    add("wall_teach.png", "teach", "print", {}, 0.0);
    for (const double yaw_rad : {-0.3, 0.0, 0.4})
      add("still" + std::to_string(stills_++) + ".png", "static", "print", {yaw_rad, {0, 0, 0.2}}, 0.0);
    for (int i = 0; i < kFrames; ++i)
      add("walk" + std::to_string(i) + ".png", "walk", "print", {0.02 * i, {0.01 * i, 0, 0.1}}, i / 15.0);
    add("plain_teach.png", "teach", "plain", {}, 0.0);
    add("plain.png", "static", "plain", {}, 0.0);
    test::write_text(set_ + "/truth.csv", truth_);
  }
  void add(const std::string& image, const std::string& kind, const std::string& print,
           const test::TrueMotion& motion, double t_s) {
    cv::Mat picture(test::kHeight_px, test::kWidth_px, CV_8UC1, cv::Scalar(120));
    if (print != "plain") picture = motion.picture(test::printed_plane());
    cv::imwrite(set_ + "/images/" + image, picture);
    std::ostringstream row;
    row << image << ',' << kind << ",wall," << print << ",still,none," << t_s << ",1.5,"
        << motion.yaw_rad * 180 / CV_PI << ',' << motion.yaw_rad * 180 / CV_PI << ",0,0,0,0,1.7,"
        << test::kRoi << ",1.5\n";
    truth_ += row.str();
  }
  std::string image(const std::string& name) const { return set_ + "/images/" + name; }

  static constexpr int kFrames = test::kSanitized ? 6 : 20;
  std::string set_ = folder_.file("set"), out_ = folder_.file("out"), truth_;
  int stills_ = 0;
};

TEST_F(ForeignSet, IsAnsweredAsByHeelTeachAndHeelPose) {
  const Outcome experiment = run_heel({"experiment", "foreign", "--foreign-set", set_, "-o", out_});
  ASSERT_EQ(experiment.status, 0) << experiment.err;
  EXPECT_THAT(experiment.out, HasSubstr("| stills, 1-3 m, up to 45 | 4 | 0.75 | 0.75 |"));
  EXPECT_THAT(experiment.out, HasSubstr("refused by teach: wall plain - only 0 features"));
  const CsvTable rows(out_ + "/foreign.csv");
  ASSERT_EQ(rows.rows(), 4U + kFrames);
  EXPECT_EQ(rows.text(3, "reason"), "no template");

  const std::string shirt = folder_.file("wall.heel"), camera = set_ + "/camera.yaml";
  expect_done({"teach", "--image", image("wall_teach.png"), "--roi", test::kRoi, "--distance", "1.5",
               "--camera-info", camera, "-o", shirt});
  const auto expect_answers = [&](const std::vector<std::string>& images, std::size_t row) {
    std::vector<std::string> arguments = {"pose", "--template", shirt,    "--camera-info",
                                          camera, "--json",     "--rate", "15"};
    for (const std::string& name : images) arguments.push_back(image(name));
    std::istringstream lines(run_heel(arguments).out);
    for (std::string line; std::getline(lines, line); ++row) {
      const auto pose = nlohmann::json::parse(line);
      SCOPED_TRACE(rows.text(row, "image") + ": " + line);
      ASSERT_TRUE(pose["found"].get<bool>());
      EXPECT_EQ(rows.number(row, "found"), 1.0);
      EXPECT_NEAR(rows.number(row, "certainty"), pose["certainty"].get<double>(), 1e-9);
      EXPECT_NEAR(rows.number(row, "yaw_deg"), pose["yaw_rad"].get<double>() * 180 / CV_PI, 1e-8);
      EXPECT_NEAR(rows.number(row, "yaw_sigma_deg"), pose["yaw_sigma_rad"].get<double>() * 180 / CV_PI, 1e-8);
    }
  };
  for (int i = 0; i < 3; ++i)
    expect_answers({"still" + std::to_string(i) + ".png"}, static_cast<std::size_t>(i));
  std::vector<std::string> walk;
  for (int i = 0; i < kFrames; ++i) walk.push_back("walk" + std::to_string(i) + ".png");
  expect_answers(walk, 4);
}

TEST_F(ForeignSet, IsReportedBesidePlanarMatchingAndDrawn) {
  if (test::kSanitized) GTEST_SKIP() << "what is added here is OpenCV's, which is not sanitized, and Python";
  expect_done({"experiment", "foreign", "foreign-planar", "foreign-false", "--foreign-set", set_, "--data",
               folder_.path().string(), "-o", out_});
  const CsvTable planar(out_ + "/foreign_planar.csv");
  std::map<std::string, int> found_turned;
  for (std::size_t row = 0; row < planar.rows(); ++row)
    if (planar.number(row, "found") != 0.0 && planar.text(row, "kind") == "static" &&
        std::abs(planar.number(row, "yaw_deg") - planar.number(row, "yaw_back_deg")) < 3.0)
      ++found_turned[planar.text(row, "method")];
  for (const char* method : {"ORB(3000)", "SIFT", "SIFT on the picture enlarged by two", "AKAZE"})
    EXPECT_EQ(found_turned[method], 3) << method << ": the wall is a plane";

  const Outcome report = run_heel({"report", out_});
  ASSERT_EQ(report.status, 0) << report.err;
  for (const char* text :
       {"| 1 to 3 m, up to 45° | 4 | 75 % |", "| ORB(3000) | 75 % |", "Skipped: no data of markers",
        "| every print | the stills of all other prints | 1 | 0 |"})
    EXPECT_THAT(report.out, HasSubstr(text));
  EXPECT_THAT(report.out, Not(HasSubstr("Goals of the design"))) << "nothing of it was measured";
  test::expect_figure(out_ + "/foreign_reliability", {1200, 570});
}

}  // namespace
}  // namespace heel
