// heel setup without a robot: what it asks, what it writes, and a calibration from pictures of a board.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "config/config_load.h"
#include "files/camera_info.h"
#include "files/csv_table.h"
#include "files/image_file.h"
#include "support/test_data.h"
#include "tools/heel/rendered_board.h"
#include "tools/heel/run_heel.h"

namespace heel {
namespace {

using nlohmann::json;
using test::BoardPose;
using test::Outcome;
using test::Process;
using ::testing::HasSubstr;
using ::testing::Not;

namespace fs = std::filesystem;

/// With these the board comes within 10 % of each edge of the picture.
const std::vector<BoardPose> kEdgePoses = {
    {0, 0, 0, -0.07, -0.06, 0.42}, {0, 0, 2, 0.08, -0.06, 0.42}, {15, 0, 0, 0.07, 0.06, 0.42},
    {0, 15, 0, -0.08, 0.06, 0.42}, {-20, 0, 5, 0.07, 0.0, 0.42}, {0, -20, -5, -0.08, 0.0, 0.42},
};

/// The region of a taught picture.
cv::Rect2d chosen_region(const CsvTable& truth, const std::string& picture) {
  for (std::size_t row = 0; row < truth.rows(); ++row)
    if (truth.text(row, "image") == picture)
      return {truth.number(row, "roi_x"), truth.number(row, "roi_y"), truth.number(row, "roi_w"),
              truth.number(row, "roi_h")};
  return {};
}

class Setup : public ::testing::Test {
 protected:
  std::string file(const std::string& name) const { return folder_.file(name); }

  /// A camera that shows each view in two pictures.
  void write_boards(std::vector<BoardPose> poses) const {
    fs::create_directory(file("boards"));
    int number = 10;
    for (const BoardPose& pose : poses) {
      const std::string first = file("boards/" + std::to_string(number++) + ".png");
      write_image(first, test::render_board(pose));
      fs::create_symlink(first, file("boards/" + std::to_string(number++) + ".png"));
    }
  }
  std::string write_config(const std::string& text) const {
    return test::write_text(file("heel.toml"), text);
  }
  Outcome set_up(std::vector<std::string> more) const {
    more.insert(more.begin(), {"setup", "--config", file("heel.toml")});
    return test::run_heel(more);
  }
  /// The JSON line of the only step.
  json step(std::vector<std::string> more, int status = 0) const {
    more.emplace_back("--json");
    const Outcome outcome = set_up(more);
    EXPECT_EQ(outcome.status, status) << outcome.out << outcome.err;
    return json::parse(outcome.out.substr(0, outcome.out.find('\n')), nullptr, false);
  }
  Outcome answered(const std::string& answers, const std::string& options) const {
    return test::run_program({"/bin/sh", "-c",
                              "printf '" + answers + "' | " + test::built_program("heel") +
                                  " setup --config " + file("heel.toml") + " " + options});
  }
  Config config() const { return load_config(file("heel.toml")).config; }

  test::TemporaryFolder folder_;
};

TEST_F(Setup, AskedForItsCameraItMakesThePictureUprightAndKeepsTheRestOfTheFile) {
  write_boards({test::kGoodPoses[5]});
  write_config(
      "# mine\n[robot]\naddress = \"tcp:robot:8101\"  # in the hall\n\n[camera]\nfile_speed = 0 # fast\n");
  const Outcome outcome =
      answered("nothing\\nfile:" + file("boards") + "\\n90\\nmirror\\nupside\\nyes\\n", "--step camera");
  EXPECT_EQ(outcome.status, 0) << outcome.out << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("'nothing' (expected a number of the list or an address"));
  EXPECT_THAT(outcome.out, HasSubstr("'upside' (expected yes, 90, 180, 270 or mirror)"));
  const cv::Mat sent = read_grey_image(file("boards/10.png")).grey;
  cv::Mat turned;
  cv::rotate(sent, turned, cv::ROTATE_90_CLOCKWISE);
  cv::flip(turned, turned, 1);
  EXPECT_EQ(cv::norm(turned, read_grey_image(file("setup-camera.png")).grey, cv::NORM_INF), 0.0);
  EXPECT_EQ(config().camera.rotate, 270);
  EXPECT_TRUE(config().camera.mirror);
  EXPECT_EQ(
      test::read_text(file("heel.toml")),
      "# mine\n[robot]\naddress = \"tcp:robot:8101\"  # in the hall\n\n[camera]\nfile_speed = 0 # fast\n"
      "source = \"file:" +
          file("boards") + "\"\nrotate = 270\nmirror = true\n");
}

TEST_F(Setup, LivePicturesOfABoardCalibrateTheCamera) {
  std::vector<BoardPose> poses = test::kGoodPoses;
  poses.insert(poses.end(), kEdgePoses.begin(), kEdgePoses.end());
  write_boards(poses);
  write_config("[camera]\nsource = \"file:boards\"\nfile_speed = 0\n");
  const json result = step({"--step", "calibration", "--board", "9x6", "--square", "0.03"});
  EXPECT_EQ(result["verdict"], "pass") << result;
  EXPECT_EQ(result["values"]["file"], file("camera.yaml"));
  EXPECT_EQ(result["values"]["warning"], "");
  EXPECT_GE(result["values"]["views"], 8);
  const CameraModel camera = read_camera_model(file("camera.yaml"));
  EXPECT_NEAR(camera.fx, test::kTrueK(0, 0), 3.0);
  EXPECT_NEAR(camera.cx, test::kTrueK(0, 2), 3.0);
}

TEST_F(Setup, ViewsThatDoNotDetermineTheCameraAreRefusedWithWhatIsMissing) {
  std::vector<BoardPose> parallel;
  for (const double x_m : {-0.07, 0.0, 0.07})
    for (const double y_m : {-0.06, 0.0, 0.06}) parallel.push_back({0, 0, 0, x_m, y_m, 0.42});
  write_boards(parallel);
  write_config("[camera]\nsource = \"file:boards\"\nfile_speed = 0\n");
  const Outcome outcome = set_up({"--step", "calibration", "--board", "9x6", "--square", "0.03", "--yes"});
  EXPECT_EQ(outcome.status, 1) << outcome.out;
  EXPECT_THAT(outcome.out, HasSubstr("tilt it 30 to 45 degrees"));
  // After the first view, in the upper left.
  EXPECT_THAT(outcome.out, HasSubstr("view 1    # # ."));
  EXPECT_THAT(outcome.out, HasSubstr("not yet: upper right, right, lower left, lower middle, lower right"));
  EXPECT_FALSE(fs::exists(file("camera.yaml")));
}

TEST_F(Setup, AViewThatIsMovingOrKnownIsNotKept) {
  std::vector<BoardPose> poses(6, test::kGoodPoses[0]);
  write_boards(poses);
  // One picture only of another view: the board moves.
  write_image(file("boards/99.png"), test::render_board(test::kGoodPoses[1]));
  write_config("[camera]\nsource = \"file:boards\"\nfile_speed = 0\n");
  const json result = step({"--step", "calibration", "--board", "9x6", "--square", "0.03", "--yes"}, 1);
  EXPECT_THAT(result["measured"], "only 1 views of the 9x6 board (expected at least 5)");
}

TEST_F(Setup, ACalibrationOfAnotherSizeIsRefused) {
  CameraModel camera;
  camera.width_px = 1280, camera.height_px = 720, camera.fx = camera.fy = 900, camera.cx = 640,
  camera.cy = 360;
  write_camera_model(camera, file("other.yaml"));
  write_config("");
  const json result = step({"--step", "calibration", "--camera-info", file("other.yaml"), "--yes"}, 1);
  EXPECT_THAT(result["advice"], HasSubstr("640x480"));
  EXPECT_EQ(test::read_text(file("heel.toml")), "") << "it is not taken";
}

TEST_F(Setup, ATurnThatIsNotGivenStays) {
  write_boards({test::kGoodPoses[0]});
  write_config("[camera]\nsource = \"file:boards\"\nfile_speed = 0\nrotate = 180\n");
  step({"--step", "camera", "--camera", "file:" + file("boards"), "--mirror", "--yes"});
  EXPECT_EQ(config().camera.rotate, 180);
  EXPECT_TRUE(config().camera.mirror);
  step({"--step", "camera", "--camera", "file:" + file("boards"), "--rotate", "90", "--yes"});
  EXPECT_EQ(config().camera.rotate, 90);
  EXPECT_TRUE(config().camera.mirror);
}

TEST_F(Setup, ACalibrationInAnotherFolderIsSomebodysOwn) {
  std::vector<BoardPose> poses = test::kGoodPoses;
  poses.insert(poses.end(), kEdgePoses.begin(), kEdgePoses.end());
  write_boards(poses);
  fs::create_directory(file("mine"));
  const std::string mine = test::write_text(file("mine/lab.yaml"), "# mine\n");
  write_config("[camera]\nsource = \"file:boards\"\nfile_speed = 0\ninfo = \"mine/lab.yaml\"\n");
  step({"--step", "calibration", "--board", "9x6", "--square", "0.03"});
  EXPECT_EQ(test::read_text(mine), "# mine\n");
  EXPECT_EQ(config().camera.info, file("lab.yaml"));
  EXPECT_NEAR(read_camera_model(file("lab.yaml")).fx, test::kTrueK(0, 0), 3.0);
}

TEST_F(Setup, WhatCannotBeKeptIsNamedBeforeAnythingIsAsked) {
  write_config("[target]\nshirt = \"/proc/none/shirt.heel\"\n[camera]\ninfo = \"/proc/none/camera.yaml\"\n");
  for (const char* name : {"shirt", "calibration"}) {
    const Outcome outcome = set_up({"--step", name, "--board", "9x6", "--square", "0.03", "--yes"});
    EXPECT_EQ(outcome.status, 1) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("its folder cannot be written")) << name;
    EXPECT_THAT(outcome.out, Not(HasSubstr("The person stands")));
    EXPECT_THAT(outcome.out, Not(HasSubstr("Move the board")));
  }
}

TEST_F(Setup, ADistanceByTapeAndByDrivingAreNotGivenTogether) {
  write_config("");
  const Outcome outcome = set_up({"--step", "shirt", "--distance", "1.5", "--drive-back", "--yes"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--distance"));
}

/// The sharpest picture shows a shirt, and the others are too blurred for it to be found.
TEST_F(Setup, AShirtThatDoesNotPassLeavesTheOneBefore) {
  HEEL_NEEDS_TEST_DATA("foreign");
  const std::string data = test::data_path("foreign");
  const cv::Mat sharp = read_grey_image(data + "/images/given_teach_avgman_blobs.jpg").grey;
  cv::Mat blurred;
  cv::GaussianBlur(sharp, blurred, {0, 0}, 12.0);
  fs::create_directory(file("seen"));
  for (int i = 0; i < 8; ++i) write_image(file(fmt::format("seen/{}.png", i)), i == 3 ? sharp : blurred);
  const std::string shirt = test::write_text(file("shirt.heel"), "the one before");
  write_config("[camera]\nsource = \"file:seen\"\nfile_speed = 0\ninfo = \"" + data +
               "/camera.yaml\"\nmount_z_m = 1.05\n");
  const json result = step({"--step", "shirt", "--distance", "1.4991", "--height", "1.77", "--countdown", "0",
                            "--reach-time", "0", "--yes"},
                           1);
  EXPECT_THAT(result["measured"], HasSubstr("the shirt taught before is kept"));
  EXPECT_EQ(test::read_text(shirt), "the one before");
}

TEST_F(Setup, WithoutAnAnswerItNamesTheOptionAndHowToGoOn) {
  const Outcome outcome = set_up({"--step", "shirt", "--step", "check", "--yes"});
  EXPECT_EQ(outcome.status, 1) << outcome.out << outcome.err;  // no calibration: the step fails
  const Outcome asked = set_up({"--step", "camera"});
  EXPECT_EQ(asked.status, 2) << asked.out;
  EXPECT_THAT(asked.err, HasSubstr("heel setup: no answer to 'Which camera?"));
  EXPECT_THAT(asked.err, HasSubstr("expected --camera or a line on standard input"));
  EXPECT_THAT(asked.out, HasSubstr("heel setup --config " + file("heel.toml") + " --step camera\n"));
}

/// A command line that is to be copied.
TEST_F(Setup, AFolderWithSpacesIsQuotedWhereItIsToGoOn) {
  fs::create_directory(file("my robot's"));
  const std::string config = file("my robot's/heel.toml");
  const Outcome asked = test::run_heel({"setup", "--step", "camera", "--config", config});
  EXPECT_EQ(asked.status, 2) << asked.out;
  const std::size_t begin = asked.out.find("  heel setup --config ");
  ASSERT_NE(begin, std::string::npos) << asked.out;
  const std::string line = asked.out.substr(begin, asked.out.find('\n', begin) - begin);
  const Outcome words = test::run_program({"/bin/sh", "-c", "heel() { printf '<%s>' \"$@\"; }; " + line});
  EXPECT_EQ(words.out, "<setup><--config><" + config + "><--step><camera>");
}

/// What the shirt step needs, with a picture in which a person could stand.
TEST_F(Setup, AShirtIsAskedForInWordsOfOneLevelAndNobodyThereIsNoFaultOfIt) {
  write_camera_model({.width_px = 640, .height_px = 480, .fx = 600, .fy = 600, .cx = 320, .cy = 240},
                     file("camera.yaml"));
  write_image(file("back.png"), test::render_board(test::kGoodPoses[0]));
  write_config("[camera]\nsource = \"file:back.png\"\ninfo = \"camera.yaml\"\n");
  const std::string options = "--step shirt --height 1.75 --countdown 0 --reach-time 0";
  const Outcome nobody = answered("", options);
  EXPECT_EQ(nobody.status, 2) << nobody.out;
  EXPECT_THAT(nobody.err, HasSubstr("no answer to 'From the camera to the back"));
  EXPECT_THAT(nobody.err, HasSubstr("(expected --distance or --drive-back or a line on standard input)"));
  EXPECT_THAT(nobody.out, HasSubstr("--step shirt\n"));
  EXPECT_THAT(nobody.out, Not(HasSubstr("pass the steps before first")));
  const Outcome outline = answered("1,2,3\\n600,140,160,200\\n", options + " --distance 1.5");
  EXPECT_EQ(outline.status, 2) << outline.out;
  EXPECT_THAT(outline.out,
              HasSubstr("\n'1,2,3' (expected X,Y,W,H: left, top, width and height in whole pixels"));
  EXPECT_THAT(outline.out, HasSubstr("\n'600,140,160,200' (expected X,Y,W,H inside the 640x480 image"));
  EXPECT_THAT(outline.err, HasSubstr("expected --roi or a line on standard input"));
}

TEST_F(Setup, AnInterruptAtAQuestionKeepsWhatWasDone) {
  write_boards({test::kGoodPoses[0]});
  ASSERT_EQ(mkfifo(file("answers").c_str(), 0600), 0);
  const std::string program = test::built_program("heel");
  Process heel({"/bin/sh", "-c",
                "exec " + program + " setup --config " + file("heel.toml") +
                    " --camera file:" + file("boards") + " <> " + file("answers")});
  ASSERT_TRUE(heel.says("Upright")) << heel.output();
  heel.signal(SIGINT);
  EXPECT_EQ(heel.wait(), 1) << heel.output();
  EXPECT_THAT(heel.output(), HasSubstr("stopped\nWhat was done is kept in " + file("heel.toml")));
  EXPECT_THAT(heel.output(), HasSubstr("--step camera --step calibration --step robot"));
  EXPECT_EQ(config().camera.source, "file:" + file("boards"));
}

/// Regions that people chose in the pictures of bodies by others.
TEST_F(Setup, TheProposedOutlineIsTheBack) {
  HEEL_NEEDS_TEST_DATA("foreign");
  const std::string data = test::data_path("foreign");
  const CsvTable truth(data + "/truth.csv");
  struct Body {
    const char* name;
    const char* height_m;
  };
  int bodies = 0;
  for (const Body& body : {Body{"avgman", "1.77"}, Body{"slimwoman", "1.64"}, Body{"heavyman", "1.76"}}) {
    const std::string name = "given_teach_" + std::string(body.name) + "_blobs.jpg";
    write_config("[camera]\nsource = \"file:" + data + "/images/" + name + "\"\ninfo = \"" + data +
                 "/camera.yaml\"\nmount_z_m = 1.05\n");
    const json result = step({"--step", "shirt", "--distance", "1.4991", "--height", body.height_m,
                              "--countdown", "0", "--reach-time", "0", "--yes"});
    ASSERT_TRUE(result.contains("values")) << result;
    const json& roi = result["values"]["roi"];
    const cv::Rect2d proposed(roi[0], roi[1], roi[2], roi[3]);
    ++bodies;
    const cv::Rect2d chosen = chosen_region(truth, name);
    EXPECT_GT((proposed & chosen).area() / (proposed | chosen).area(), 0.7) << name << roi;
  }
  EXPECT_EQ(bodies, 3);
}

}  // namespace
}  // namespace heel
