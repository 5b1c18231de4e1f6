// heel calibrate compared with truth: views of a chessboard, rendered through a known camera with distortion.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "files/camera_info.h"
#include "heel/camera_model.h"
#include "support/test_data.h"
#include "tools/heel/rendered_board.h"
#include "tools/heel/run_heel.h"

namespace heel {
namespace {

using test::Outcome;
using test::run_heel;
using test::TemporaryFolder;
using ::testing::AllOf;
using ::testing::HasSubstr;

using test::BoardPose;
using test::kGoodPoses;
using test::kHeight_px;
using test::kInnerCorners;
using test::kSquare_m;
using test::kTrueDistortion;
using test::kTrueK;
using test::kWidth_px;
using test::render_board;

/// A drawing of a board in a plane, 1000 px a metre, seen by a camera without distortion.
cv::Mat picture_of(const cv::Mat& drawing, const BoardPose& pose) {
  const double rad = CV_PI / 180.0;
  cv::Matx33d Rx, Ry, Rz;
  cv::Rodrigues(cv::Vec3d(pose.pitch_deg * rad, 0, 0), Rx);
  cv::Rodrigues(cv::Vec3d(0, pose.yaw_deg * rad, 0), Ry);
  cv::Rodrigues(cv::Vec3d(0, 0, pose.roll_deg * rad), Rz);
  const cv::Matx33d R = Rz * Ry * Rx;
  const cv::Vec3d t = cv::Vec3d(pose.x_m, pose.y_m, pose.z_m) -
                      R * cv::Vec3d(0.0005 * drawing.cols, 0.0005 * drawing.rows, 0);
  const cv::Matx33d camera_from_drawing(R(0, 0), R(0, 1), t[0], R(1, 0), R(1, 1), t[1], R(2, 0), R(2, 1),
                                        t[2]);
  const cv::Matx33d H = kTrueK * camera_from_drawing * cv::Matx33d(0.001, 0, 0, 0, 0.001, 0, 0, 0, 1);
  // Four times as large, then made smaller, so that edges are smooth.
  cv::Mat large, picture;
  const cv::Matx33d to_large(4, 0, 1.5, 0, 4, 1.5, 0, 0, 1);
  cv::warpPerspective(drawing, large, to_large * H, {4 * kWidth_px, 4 * kHeight_px}, cv::INTER_LINEAR,
                      cv::BORDER_CONSTANT, cv::Scalar(230));
  cv::resize(large, picture, {kWidth_px, kHeight_px}, 0, 0, cv::INTER_AREA);
  return picture;
}

cv::Mat drawn_circles(bool asymmetric) {
  cv::Mat drawing(asymmetric ? 290 : 240, 330, CV_8U, cv::Scalar(230));
  for (int row = 0; row < (asymmetric ? 11 : 6); ++row) {
    for (int column = 0; column < (asymmetric ? 4 : 8); ++column) {
      const int x = asymmetric ? 2 * column + row % 2 : column;
      const int step = asymmetric ? 20 : 30;
      cv::circle(drawing, {50 + step * x, 45 + step * row}, asymmetric ? 7 : 9, cv::Scalar(25), cv::FILLED,
                 cv::LINE_AA);
    }
  }
  return drawing;
}

/// `with_markers`: a ChArUco board, with a marker of 6 x 6 cells in each white square.
cv::Mat drawn_chessboard(bool with_markers = false) {
  cv::Mat drawing(270, 360, CV_8U, cv::Scalar(235));
  cv::RNG random(3);
  for (int row = 0; row < 7; ++row) {
    for (int column = 0; column < 10; ++column) {
      cv::Mat square = drawing(cv::Rect(30 + 30 * column, 30 + 30 * row, 30, 30));
      if ((row + column) % 2 == 0) square.setTo(25);
      if ((row + column) % 2 == 0 || !with_markers) continue;
      for (int cell = 0; cell < 36; ++cell) {
        const bool border = cell % 6 == 0 || cell % 6 == 5 || cell / 6 == 0 || cell / 6 == 5;
        if (border || random.uniform(0, 2) == 0)
          square(cv::Rect(4 + cell % 6 * 22 / 6, 4 + cell / 6 * 22 / 6, 4, 4)).setTo(25);
      }
    }
  }
  return drawing;
}

class Calibrate : public ::testing::Test {
 protected:
  std::vector<std::string> write_views(const std::vector<BoardPose>& poses) {
    std::vector<std::string> images;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      images.push_back(folder.file("view" + std::to_string(i) + ".png"));
      cv::imwrite(images.back(), render_board(poses[i]));
    }
    return images;
  }
  std::vector<std::string> write_pictures(const cv::Mat& drawing, const std::vector<BoardPose>& poses) {
    std::vector<std::string> images;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      images.push_back(folder.file("picture" + std::to_string(i) + ".png"));
      cv::imwrite(images.back(), picture_of(drawing, poses[i]));
    }
    return images;
  }
  Outcome calibrate(std::vector<std::string> images, const std::string& board = "9x6") {
    std::vector<std::string> arguments = {"calibrate", "--board", board, "--square", "0.03", "-o", output};
    arguments.insert(arguments.end(), images.begin(), images.end());
    return run_heel(arguments);
  }

  TemporaryFolder folder;
  std::string output = folder.file("camera.yaml");
};

TEST_F(Calibrate, FindsTheTrueCamera) {
  const Outcome outcome = calibrate(write_views(kGoodPoses));
  ASSERT_EQ(outcome.status, 0) << outcome.err;

  EXPECT_EQ(outcome.err, "");
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("view7.png"), HasSubstr("rms 0.0"), HasSubstr("over 8 views")));

  const CameraModel camera = read_camera_model(output);
  EXPECT_EQ(camera.width_px, kWidth_px);
  EXPECT_EQ(camera.height_px, kHeight_px);
  EXPECT_NEAR(camera.fx, kTrueK(0, 0), 1.0);
  EXPECT_NEAR(camera.fy, kTrueK(1, 1), 1.0);
  EXPECT_NEAR(camera.cx, kTrueK(0, 2), 1.0);
  EXPECT_NEAR(camera.cy, kTrueK(1, 2), 1.0);
  EXPECT_NEAR(camera.k1, kTrueDistortion[0], 0.01);
  EXPECT_NEAR(camera.k2, kTrueDistortion[1], 0.05);
  EXPECT_NEAR(camera.p1, kTrueDistortion[2], 0.001);
  EXPECT_NEAR(camera.p2, kTrueDistortion[3], 0.001);
  EXPECT_EQ(camera.k3, 0.0);
}

TEST_F(Calibrate, PrintsOneJsonObjectOnRequest) {
  std::vector<std::string> images = write_views(kGoodPoses);
  images.emplace_back("--json");
  const Outcome outcome = calibrate(images);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out, nullptr, /*allow_exceptions=*/false);
  ASSERT_TRUE(json.is_object()) << outcome.out;
  EXPECT_EQ(json["output"], output);
  EXPECT_NEAR(json["fx"].get<double>(), kTrueK(0, 0), 1.0);
  EXPECT_EQ(json["views"].size(), kGoodPoses.size());
  EXPECT_EQ(json["distortion"].size(), 5U);
}

TEST_F(Calibrate, SaysWhatCountsWhenSquaresAreGivenForCorners) {
  const std::vector<BoardPose> poses(kGoodPoses.begin(), kGoodPoses.begin() + 5);
  const Outcome outcome = calibrate(write_pictures(drawn_chessboard(), poses), "10x7");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("only 0 of 5"), HasSubstr("counts inner corners"),
                                 HasSubstr("9x6 is seen in 5 of 5")));
  EXPECT_THAT(outcome.out,
              AllOf(HasSubstr("picture0.png"), HasSubstr("found in part  (1 of 5"), HasSubstr("(5 of 5)")));
}

TEST_F(Calibrate, TakesGridsOfCircles) {
  for (const bool asymmetric : {false, true}) {
    write_pictures(drawn_circles(asymmetric), kGoodPoses);
    const Outcome outcome = run_heel(
        {"calibrate", folder.path().string(), "--pattern", asymmetric ? "asymmetric-circles" : "circles",
         "--board", asymmetric ? "4x11" : "8x6", "--square", asymmetric ? "0.02" : "0.03", "-o", output});
    ASSERT_EQ(outcome.status, 0) << asymmetric << outcome.err << outcome.out;
    const CameraModel camera = read_camera_model(output);
    EXPECT_NEAR(camera.fx, kTrueK(0, 0), 6.0) << asymmetric;
    EXPECT_NEAR(camera.cx, kTrueK(0, 2), 4.0) << asymmetric;
    std::filesystem::remove(output);
  }
}

TEST_F(Calibrate, TakesChessboardsWithMarkers) {
  write_pictures(drawn_chessboard(true), kGoodPoses);
  const Outcome outcome = run_heel({"calibrate", folder.path().string(), "--pattern", "charuco", "--board",
                                    "9x6", "--square", "0.03", "-o", output});
  ASSERT_EQ(outcome.status, 0) << outcome.err << outcome.out;
  EXPECT_THAT(outcome.out, HasSubstr("over 8 views"));
  const CameraModel camera = read_camera_model(output);
  EXPECT_NEAR(camera.fx, kTrueK(0, 0), 3.0);
  EXPECT_NEAR(camera.cx, kTrueK(0, 2), 4.0) << "the markers are 4 px from the corners";
}

TEST_F(Calibrate, AChessboardIsNoCharucoBoard) {
  write_pictures(drawn_chessboard(), kGoodPoses);
  const Outcome outcome = run_heel({"calibrate", folder.path().string(), "--pattern", "charuco", "--board",
                                    "9x6", "--square", "0.03", "-o", output});
  EXPECT_EQ(outcome.status, 2) << outcome.out;
  EXPECT_THAT(outcome.err,
              HasSubstr("--pattern: 'charuco', but only 0 of 8 views of the board have markers"));
  EXPECT_FALSE(std::filesystem::exists(output));
}

TEST_F(Calibrate, TakesBoardsThatTheEdgeOfThePictureCuts) {
  for (const bool markers : {false, true}) {
    std::vector<BoardPose> poses(kGoodPoses.begin(), kGoodPoses.begin() + 3);
    for (const double side : {-1.0, 1.0})
      for (const double end : {-1.0, 1.0})
        poses.push_back({end * 24, side * 20, 4, side * 0.13, end * 0.08, 0.42});
    write_pictures(drawn_chessboard(markers), poses);
    const Outcome outcome =
        run_heel({"calibrate", folder.path().string(), "--pattern", markers ? "charuco" : "chessboard",
                  "--board", "9x6", "--square", "0.03", "-o", output});
    ASSERT_EQ(outcome.status, 0) << outcome.err << outcome.out;
    EXPECT_THAT(outcome.out, AllOf(HasSubstr("found in part"), HasSubstr("over 7 views")));
    const CameraModel camera = read_camera_model(output);
    EXPECT_NEAR(camera.fx, kTrueK(0, 0), 3.0) << markers;
    EXPECT_NEAR(camera.cx, kTrueK(0, 2), 4.0) << markers;
    std::filesystem::remove(output);
  }
}

/// In this view a row of corners is found that the board does not have.
TEST_F(Calibrate, LeavesOutAPartWithCornersInWrongPlaces) {
  std::vector<BoardPose> poses(kGoodPoses.begin(), kGoodPoses.begin() + 4);
  poses.push_back({-37, -41, -3, -0.05, 0.16, 0.52});
  const Outcome outcome = calibrate(write_pictures(drawn_chessboard(), poses));
  EXPECT_EQ(outcome.status, 2) << outcome.out;
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("only 4 of 5 images"), HasSubstr("picture4.png")));
}

TEST_F(Calibrate, RefusesViewsThatDoNotShowTheEdges) {
  std::vector<BoardPose> far;
  for (const BoardPose& pose : kGoodPoses)
    far.push_back({pose.pitch_deg, pose.yaw_deg, pose.roll_deg, 0.1 * pose.x_m, 0.1 * pose.y_m, 1.6});
  std::vector<std::string> images = write_pictures(drawn_chessboard(), far);
  cv::RNG random(5);
  for (const std::string& image : images) {
    cv::Mat picture = cv::imread(image, cv::IMREAD_GRAYSCALE), noise(picture.size(), CV_16S), noisy;
    random.fill(noise, cv::RNG::NORMAL, 0, 12);
    cv::add(picture, noise, noisy, cv::noArray(), CV_8U);
    cv::imwrite(image, noisy);
  }
  const Outcome outcome = calibrate(images);
  EXPECT_EQ(outcome.status, 2) << outcome.out;
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("the views do not determine the "),
                                 HasSubstr("no view shows the board in the left 4"), HasSubstr("add views")));
  EXPECT_FALSE(std::filesystem::exists(output));
}

/// Such pictures took minutes.
TEST_F(Calibrate, SaysThatPicturesAreSqueezedAndThatTheEndOfOneIsMissing) {
  std::vector<std::string> images = write_views(kGoodPoses);
  for (const std::string& image : images) {
    cv::Mat squeezed;
    cv::resize(cv::imread(image, cv::IMREAD_GRAYSCALE), squeezed, {kWidth_px, kHeight_px * 2 / 3}, 0, 0,
               cv::INTER_AREA);
    cv::imwrite(image, squeezed);
  }
  std::vector<unsigned char> jpeg;
  cv::imencode(".jpg", cv::imread(images.back(), cv::IMREAD_GRAYSCALE), jpeg);
  images.back() = test::write_text(folder.file("last.jpg"), std::string(jpeg.begin(), jpeg.end() - 2));
  const Outcome outcome = calibrate(images);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("warning: "), HasSubstr("were the pictures squeezed to 640x320")));
  EXPECT_THAT(outcome.err, HasSubstr(images.back() + ": its end is missing"));
}

TEST_F(Calibrate, SaysThatTheBoardIsSeenInPart) {
  const std::vector<std::string> images = write_views(kGoodPoses);
  for (const std::string& image : images) {
    cv::Mat glaring = cv::imread(image, cv::IMREAD_GRAYSCALE);
    cv::circle(glaring, {kWidth_px / 2, kHeight_px / 2}, 70, cv::Scalar(255), cv::FILLED);
    cv::imwrite(image, glaring);
  }
  const Outcome outcome = calibrate(images);
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("more show a part of it: does something cover it"));
}

TEST_F(Calibrate, IsDoneSoonWithPicturesOfNoise) {
  cv::Mat noise(960, 1280, CV_8U);
  cv::randu(noise, 0, 255);
  const std::string image = folder.file("noise.png");
  cv::imwrite(image, noise);
  const double start_s = test::monotonic_s();
  EXPECT_EQ(calibrate({image}).status, 2);
  EXPECT_LT(test::monotonic_s() - start_s, 60.0);
}

TEST_F(Calibrate, JudgesTheBoardsOfPublicReports) {
  HEEL_NEEDS_TEST_DATA("reports");
  const std::string reports = test::data_path("reports/");
  const Outcome centre = calibrate({reports + "calibrate-centre-only"});
  EXPECT_EQ(centre.status, 2);
  EXPECT_THAT(centre.err, AllOf(HasSubstr("3 m away may be"), HasSubstr("no view shows the board in")));
  EXPECT_THAT(calibrate({reports + "calibrate-squares-for-corners"}, "10x7").err,
              HasSubstr("9x6 is seen in 8 of 8"));
  const Outcome dark = calibrate({reports + "calibrate-dark-photo/dark1280.png"});
  EXPECT_EQ(dark.status, 2);
  EXPECT_THAT(dark.out, HasSubstr("no board  (1 of 1)"));
  EXPECT_THAT(calibrate({reports + "calibrate-dark-photo/dark640.png"}).out, HasSubstr("no board  (1 of 1)"));
}

TEST_F(Calibrate, RefusesTooFewViewsNamingThoseWithoutABoard) {
  std::vector<std::string> images = write_views({kGoodPoses.begin(), kGoodPoses.begin() + 3});
  images.push_back(folder.file("wall.png"));
  cv::imwrite(images.back(), cv::Mat(kHeight_px, kWidth_px, CV_8UC1, cv::Scalar(128)));
  const Outcome outcome = calibrate(images);
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("only 3 of 4"), HasSubstr("not seen in"), HasSubstr("wall.png")));
  EXPECT_FALSE(std::filesystem::exists(output));
}

TEST_F(Calibrate, RefusesAViewOfAnotherBoardNamingIt) {
  // A print stretched by 6 %: every corner is found, but no camera fits these and the other views.
  std::vector<std::string> images = write_views(kGoodPoses);
  cv::Mat stretched;
  cv::warpAffine(cv::imread(images[2], cv::IMREAD_GRAYSCALE), stretched,
                 cv::Matx23d(1.0, 0.15, -30, 0, 0.94, 0), {kWidth_px, kHeight_px}, cv::INTER_LINEAR,
                 cv::BORDER_REPLICATE);
  cv::imwrite(images[2], stretched);
  const Outcome outcome = calibrate(images);
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("poor views"), HasSubstr("view2.png (")));
  EXPECT_FALSE(std::filesystem::exists(output));
}

TEST_F(Calibrate, RefusesViewsThatDoNotFixTheFocalLength) {
  std::vector<BoardPose> square_on;
  for (int i = 0; i < 6; ++i) square_on.push_back({0, 0, 2.0 * i, 0.01 * i - 0.03, 0.01 * (i % 3), 0.45});
  const Outcome outcome = calibrate(write_views(square_on));
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("focal length")) << outcome.out;
  EXPECT_FALSE(std::filesystem::exists(output));
}

TEST_F(Calibrate, RefusesImagesOfDifferentSizesNamingTheOneThatDiffers) {
  std::vector<std::string> images = write_views({kGoodPoses[0], kGoodPoses[1]});
  cv::imwrite(images[1], cv::Mat(240, 320, CV_8UC1, cv::Scalar(0)));
  const Outcome outcome = calibrate(images);
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("view1.png: 320x240"), HasSubstr("expected 640x480")));
}

TEST_F(Calibrate, RefusesImpossibleBoardSizes) {
  for (const char* board : {"9", "9x", "x6", "9x6x2", "2x6", "-9x6", "9 by 6", ""}) {
    const Outcome outcome = calibrate({"unused.png"}, board);
    EXPECT_EQ(outcome.status, 2) << board;
    EXPECT_THAT(outcome.err, HasSubstr("--board")) << board;
  }
  const Outcome even = run_heel({"calibrate", "unused.png", "--board", "4x10", "--pattern",
                                 "asymmetric-circles", "--square", "0.02", "-o", output});
  EXPECT_EQ(even.status, 2);
  EXPECT_THAT(even.err, HasSubstr("odd number of rows"));
  const Outcome unknown = run_heel({"calibrate", "unused.png", "--board", "9x6", "--pattern", "hexagons",
                                    "--square", "0.02", "-o", output});
  EXPECT_EQ(unknown.status, 2);
  EXPECT_THAT(unknown.err, HasSubstr("--pattern: 'hexagons' (expected chessboard, charuco"));
}

}  // namespace
}  // namespace heel
