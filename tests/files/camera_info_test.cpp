// Camera files as ROS and OpenCV write them, and a refusal for each possible error.
#include "files/camera_info.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "heel/camera_model.h"
#include "heel/error.h"
#include "support/complaint.h"
#include "support/temporary_folder.h"
#include "support/test_data.h"

namespace heel {
namespace {

using test::TemporaryFolder;
using test::write_text;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr char kRos[] = R"(image_width: 640
image_height: 480
camera_name: narrow_stereo
camera_matrix:
  rows: 3
  cols: 3
  data: [700.5, 0, 320.25, 0, 701.5, 240.75, 0, 0, 1]
distortion_model: plumb_bob
distortion_coefficients:
  rows: 1
  cols: 5
  data: [-0.25, 0.125, 0.001, -0.002, 0.03]
rectification_matrix:
  rows: 3
  cols: 3
  data: [1, 0, 0, 0, 1, 0, 0, 0, 1]
)";

constexpr char kOpenCv[] = R"(%YAML:1.0
---
calibration_time: "Sat 21 Nov 2026"
image_width: 1280
image_height: 720
flags: 0
camera_matrix: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 9.0025e+02, 0., 640., 0., 9.0075e+02, 3.6050e+02, 0., 0., 1. ]
distortion_coefficients: !!opencv-matrix
   rows: 5
   cols: 1
   dt: d
   data: [ -2.5e-01, .125, 0., 1.0000000000000000e-03, 0. ]
avg_reprojection_error: 2.1e-01
)";

constexpr char kOpenCvJson[] = R"({
    "image_width": 1280, "image_height": 720,
    "camera_matrix": { "type_id": "opencv-matrix", "rows": 3, "cols": 3, "dt": "d",
        "data": [ 900.25, 0.0, 640.0, 0.0, 900.75, 360.5, 0.0, 0.0, 1.0 ] },
    "distortion_coefficients": { "type_id": "opencv-matrix", "rows": 4, "cols": 1, "dt": "d",
        "data": [ -0.25, 0.125, 0.0, 1e-3 ] }
})";

class CameraFile : public ::testing::Test {
 protected:
  CameraModel read(const std::string& text) { return read_camera_model(write_text(path, text)); }
  std::string refusal_of(const std::string& text) {
    return test::complaint_of([&] { read(text); });
  }

  TemporaryFolder folder;
  std::string path = folder.file("camera.yaml");
};

TEST_F(CameraFile, ReadsRosCameraInfo) {
  const CameraModel camera = read(kRos);
  EXPECT_EQ(camera.width_px, 640);
  EXPECT_EQ(camera.height_px, 480);
  EXPECT_EQ(camera.fx, 700.5);
  EXPECT_EQ(camera.fy, 701.5);
  EXPECT_EQ(camera.cx, 320.25);
  EXPECT_EQ(camera.cy, 240.75);
  EXPECT_EQ(camera.k1, -0.25);
  EXPECT_EQ(camera.k2, 0.125);
  EXPECT_EQ(camera.p1, 0.001);
  EXPECT_EQ(camera.p2, -0.002);
  EXPECT_EQ(camera.k3, 0.03);
}

TEST_F(CameraFile, ReadsOpenCvFileStorageInYamlAndJson) {
  for (const char* text : {kOpenCv, kOpenCvJson}) {
    const CameraModel camera = read(text);
    EXPECT_EQ(camera.width_px, 1280);
    EXPECT_EQ(camera.height_px, 720);
    EXPECT_EQ(camera.fx, 900.25);
    EXPECT_EQ(camera.fy, 900.75);
    EXPECT_EQ(camera.cx, 640.0);
    EXPECT_EQ(camera.cy, 360.5);
    EXPECT_EQ(camera.k1, -0.25);
    EXPECT_EQ(camera.k2, 0.125);
    EXPECT_EQ(camera.p1, 0.0);
    EXPECT_EQ(camera.p2, 0.001);
    EXPECT_EQ(camera.k3, 0.0);
  }
}

TEST_F(CameraFile, IsReadBackToTheBit) {
  const CameraModel written{.width_px = 768,
                            .height_px = 432,
                            .fx = 700.0 / 3.0,
                            .fy = 1399.9 / 3.0,
                            .cx = 383.5,
                            .cy = 215.5,
                            .k1 = 0.1,
                            .k2 = -1.0 / 7.0,
                            .p1 = 1e-7,
                            .p2 = -3e-5,
                            .k3 = 0.2};
  write_camera_model(written, path);
  const CameraModel camera = read_camera_model(path);
  EXPECT_EQ(camera.width_px, written.width_px);
  EXPECT_EQ(camera.height_px, written.height_px);
  EXPECT_EQ(camera.fx, written.fx);
  EXPECT_EQ(camera.fy, written.fy);
  EXPECT_EQ(camera.cx, written.cx);
  EXPECT_EQ(camera.cy, written.cy);
  EXPECT_EQ(camera.k1, written.k1);
  EXPECT_EQ(camera.k2, written.k2);
  EXPECT_EQ(camera.p1, written.p1);
  EXPECT_EQ(camera.p2, written.p2);
  EXPECT_EQ(camera.k3, written.k3);
}

TEST(CameraExamples, AreReadable) {
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(test::source_path("config/camera"))) {
    if (entry.path().extension() != ".yaml") continue;
    ++files;
    const CameraModel camera = read_camera_model(entry.path().string());
    EXPECT_GT(camera.fx, 0.3 * camera.width_px) << entry.path();
    EXPECT_NEAR(camera.cx, 0.5 * camera.width_px, 0.1 * camera.width_px) << entry.path();
    EXPECT_NEAR(camera.cy, 0.5 * camera.height_px, 0.1 * camera.height_px) << entry.path();
  }
  EXPECT_GE(files, 1);
}

TEST_F(CameraFile, ReadsTheWidestAndTheLongestLens) {
  std::string wide = kRos, tele = kRos;
  wide.replace(wide.find("700.5, 0, 320.25, 0, 701.5"), 26, "128, 0, 64, 0, 256");
  tele.replace(tele.find("700.5, 0, 320.25, 0, 701.5"), 26, "6400, 0, 576, 0, 3200");
  EXPECT_EQ(read(wide).fx, 128.0);
  EXPECT_EQ(read(tele).fx, 6400.0);
  tele.replace(tele.find("-0.25, 0.125"), 12, "1000, 0");  // a pincushion that halves the view
  EXPECT_THAT(refusal_of(tele), HasSubstr("a field of view of 4° (expected 5…175°)"));
}

struct WrongFile {
  const char* from;  ///< in the ROS file
  const char* to;
  const char* key;       ///< named by the refusal …
  const char* expected;  ///< … with what was expected
};

TEST_F(CameraFile, RefusalsNameFileKeyAndWhatIsExpected) {
  const WrongFile rows[] = {
      {"image_width: 640", "", "image_width: missing", "pixels"},
      {"image_width: 640", "image_width: 640.5", "image_width: '640.5'", "whole number of pixels"},
      {"image_width: 640", "image_width: 0", "image_width", "1…32768"},
      {"image_height: 480", "image_height: [480]", "image_height: not a number", "pixels"},
      {"camera_matrix", "camera_matrlx", "camera_matrix: missing", "fx 0 cx"},
      {"700.5, 0,", "700.5,", "camera_matrix: 8 numbers", "rows × cols"},
      {"700.5, 0,", "700.5, 0.5,", "skew", "0"},
      {"700.5, 0,", "-700.5, 0,", "fx -700.5", "above 0"},
      {"700.5, 0,", "3.6, 0,", "camera_matrix.data: fx 3.6", "128…6400 px; is it in millimetres?"},
      {"701.5, 240", "3.6, 240", "camera_matrix.data: fy 3.6", "128…6400 px; is it in millimetres?"},
      {"700.5, 0,", "100000, 0,", "camera_matrix.data: fx 100000", "128…6400 px; was image_width edited?"},
      {"701.5, 240", "6000, 240", "camera_matrix.data: fy 6000 beside fx 700.5", "fy 308.22…1576.12 px"},
      {"701.5, 240", "300, 240", "camera_matrix.data: fy 300 beside fx 700.5", "fy 308.22…1576.12 px"},
      {"320.25", "9999", "cx 9999", "the middle of the picture, 64…576 px; was image_width edited?"},
      {"320.25", "-331", "cx -331", "the middle of the picture, 64…576 px)"},
      {"320.25", "1", "cx 1", "the middle of the picture, 64…576 px)"},
      {"240.75", "479", "cy 479", "the middle of the picture, 48…432 px; was image_height edited?"},
      {"240.75", "-0.5", "cy -0.5", "the middle of the picture, 48…432 px)"},
      {"700.5, 0,", "seven, 0,", "camera_matrix.data[0]: 'seven'", "finite number"},
      {"700.5, 0,", ".nan, 0,", "camera_matrix.data[0]: '.nan'", "finite number"},
      {"0, 0, 1]", "0, 1, 1]", "camera_matrix.data", "row by row"},
      {"plumb_bob", "omnidirectional", "distortion_model: 'omnidirectional'",
       "plumb_bob, rational_polynomial or equi"},
      {"plumb_bob", "equidistant", "distortion_coefficients.data: 5 numbers", "equidistant: k1 k2 k3 k4"},
      {"plumb_bob", "[plumb_bob]", "distortion_model: not a word", "plumb_bob"},
      {"image_width: 640", "image_width: 640\nimage_width: 640", "camera.yaml:2: image_width: given twice",
       "once"},
      {"rows: 3\n  cols: 3\n  data: [700", "rows: 3\n  rows: 3\n  data: [700",
       "camera.yaml:6: rows: given twice", "once"},
      {"0.125, 0.001", "0.125 .inf 0.001", "distortion_coefficients.data[2]: '.inf'", "finite number"},
      {"-0.25, 0.125, 0.001", "-1.5, 0.125, 0.001", "distortion_coefficients: the picture folds",
       "up to the corners"},
      {"cols: 5\n  data: [-0.25,", "cols: 6\n  data: [0, -0.25,", "6 numbers", "4 or 5"},
      {"image_height: 480", "image_height: 480\nbinning_x: 2", "binning_x: 2", "0 or 1"},
      {"image_height: 480", "image_height: 480\nroi: {x_offset: 10}", "roi.x_offset: 10",
       "the whole picture"},
      {"image_width: 640", "cam0: {}", "cam0: a camera chain of kalibr", "camera_info"},
      {"distortion_coefficients", "distortion_coefficient", "distortion_coefficients: missing", "k1 k2"},
      {"cols: 5\n  data: [-0.25,", "cols: 8\n  data: [0, 0, 0, -0.25,", "8 numbers: the rational model",
       "4 or 5"},
      {"image_width: 640", "<?xml version=\"1.0\"?>", "XML", "camera_info YAML"},
      {"image_width: 640", "image_width: [640", "not YAML", "camera_info"},
  };
  for (const WrongFile& row : rows) {
    std::string text = kRos;
    const std::size_t at = text.find(row.from);
    ASSERT_NE(at, std::string::npos) << row.from;
    text.replace(at, std::string(row.from).size(), row.to);
    EXPECT_THAT(refusal_of(text),
                AllOf(HasSubstr(path), HasSubstr(row.key), HasSubstr(row.expected), Not(HasSubstr("\n"))))
        << row.to;
  }
}

std::string with_distortion(const std::string& model, const std::string& numbers, int count) {
  std::string text = kRos;
  text.replace(text.find("plumb_bob"), 9, model);
  const std::size_t at = text.find("cols: 5");
  text.replace(at, text.find("rectification") - at,
               "cols: " + std::to_string(count) + "\n  data: [" + numbers + "]\n");
  return text;
}

TEST_F(CameraFile, TakesTheSameLensInOtherSpellings) {
  const struct {
    const char* model;
    const char* numbers;
    int count;
    double k1, k2, p1, p2, k3;
  } rows[] = {
      {"plumb_bob", "-0.25 0.125 0.001 -0.002 0.03", 5, -0.25, 0.125, 0.001, -0.002, 0.03},
      {"plumb_bob", "-0.25, 0.125  0.001,\n    -0.002", 4, -0.25, 0.125, 0.001, -0.002, 0.0},
      {"plumb_bob", "-0.25, 0.125, 0.001, -0.002, 0.03, 0, 0, 0.0", 8, -0.25, 0.125, 0.001, -0.002, 0.03},
      {"rational_polynomial", "-0.25, 0.125, 0.001, -0.002, 0.03, 0, 0, 0.0", 8, -0.25, 0.125, 0.001, -0.002,
       0.03},
      {"plumb_bob", "-0.25, 0.125, 0.001, -0.002, 0.03, 0, 0, 0, 0, 0, 0, 0", 12, -0.25, 0.125, 0.001, -0.002,
       0.03},
      {"'Plumb Bob'", "-0.25, 0.125, 0, 0, 0.03, 0, 0, 0, 0, 0, 0, 0, 0, 0", 14, -0.25, 0.125, 0, 0, 0.03},
      {"plumb_bob", "", 0, 0, 0, 0, 0, 0},
      {"''", "", 0, 0, 0, 0, 0, 0},
  };
  for (const auto& row : rows) {
    SCOPED_TRACE(row.numbers);
    const CameraModel camera = read(with_distortion(row.model, row.numbers, row.count));
    EXPECT_EQ(camera.lens, LensModel::PlumbBob);
    EXPECT_EQ(camera.fx, 700.5);
    EXPECT_EQ(camera.k1, row.k1);
    EXPECT_EQ(camera.k2, row.k2);
    EXPECT_EQ(camera.p1, row.p1);
    EXPECT_EQ(camera.p2, row.p2);
    EXPECT_EQ(camera.k3, row.k3);
  }
}

TEST_F(CameraFile, TakesRationalAndFisheyeLenses) {
  const std::string eight = "0.3, 0.02, 0.001, -0.002, 0.001, 0.6, 0.05, 0.004";
  for (const char* model : {"rational_polynomial", "''"}) {
    const CameraModel rational = read(with_distortion(model, eight, 8));
    EXPECT_EQ(rational.lens, LensModel::Rational);
    EXPECT_EQ(rational.k3, 0.001);
    EXPECT_EQ(rational.k4, 0.6);
    EXPECT_EQ(rational.k5, 0.05);
    EXPECT_EQ(rational.k6, 0.004);
  }
  EXPECT_THAT(refusal_of(with_distortion("plumb_bob", eight, 8)), HasSubstr("8 numbers: the rational model"));
  const std::string prism = eight + ", 0.01, 0, 0, 0";
  EXPECT_THAT(refusal_of(with_distortion("rational_polynomial", prism, 12)),
              HasSubstr("12 numbers: the thin prism model"));
  const CameraModel fisheye = read(with_distortion("equidistant", "0.01, -0.02, 0.003, -0.004", 4));
  EXPECT_EQ(fisheye.lens, LensModel::Fisheye);
  EXPECT_EQ(fisheye.k1, 0.01);
  EXPECT_EQ(fisheye.k2, -0.02);
  EXPECT_EQ(fisheye.k3, 0.003);
  EXPECT_EQ(fisheye.k4, -0.004);
  EXPECT_EQ(fisheye.p1, 0.0);
  for (const CameraModel& lens : {fisheye, read(with_distortion("rational_polynomial", eight, 8))}) {
    write_camera_model(lens, path);
    const CameraModel again = read_camera_model(path);
    EXPECT_EQ(again.lens, lens.lens);
    EXPECT_EQ(again.k4, lens.k4);
    EXPECT_EQ(again.k6, lens.k6);
  }
}

TEST_F(CameraFile, OfAFisheyeLensAreTakenUpTo175DegreesOfView) {
  const auto fisheye = [](const char* focal_px, const char* k) {
    std::string text = with_distortion("equidistant", k, 4);
    text.replace(text.find("700.5, 0, 320.25, 0, 701.5"), 26,
                 std::string(focal_px) + ", 0, 320.25, 0, " + focal_px);
    return text;
  };
  // Without coefficients, 640 px are 640 / f radians.
  EXPECT_EQ(read(fisheye("210", "0, 0, 0, 0")).lens, LensModel::Fisheye) << "174.6 degrees";
  EXPECT_THAT(refusal_of(fisheye("208", "0, 0, 0, 0")),
              AllOf(HasSubstr("a field of view of 176°"), HasSubstr("5…175°; cut the pictures")));
  EXPECT_THAT(refusal_of(fisheye("160", "0, 0, 0, 0")), HasSubstr("a field of view of 229°"));
  // The coefficients count: they make the angle at the edge smaller and larger.
  EXPECT_EQ(read(fisheye("208", "0.02, 0, 0, 0")).k1, 0.02);
  EXPECT_THAT(refusal_of(fisheye("215", "-0.03, 0, 0, 0")), HasSubstr("a field of view of "));
}

TEST_F(CameraFile, TakesACameraInfoMessageAsItIsPrinted) {
  const std::string message =
      "header:\n  seq: 3\n  stamp:\n    secs: 1500000000\n    nsecs: 1\n  frame_id: \"cam\"\n"
      "height: 480\nwidth: 640\ndistortion_model: \"plumb_bob\"\n"
      "D: [0.01, -0.02, 0.0, 0.0, 0.0]\nK: [612.0, 0.0, 331.0, 0.0, 608.0, 232.0, 0.0, 0.0, 1.0]\n"
      "binning_x: 0\nbinning_y: 0\nroi: {x_offset: 0, y_offset: 0, height: 0, width: 0, do_rectify: "
      "false}\n---\n";
  std::string ros2 = message;
  for (const auto& [from, to] :
       {std::pair{"D: [0.01, -0.02, 0.0, 0.0, 0.0]", "d:\n- 0.01\n- -0.02\n- 0.0\n- 0.0\n- 0.0"},
        std::pair{"K: [", "k: ["}})
    ros2.replace(ros2.find(from), std::string(from).size(), to);
  for (const std::string& text : {message, ros2}) {
    const CameraModel camera = read(text);
    EXPECT_EQ(camera.width_px, 640);
    EXPECT_EQ(camera.height_px, 480);
    EXPECT_EQ(camera.fx, 612.0);
    EXPECT_EQ(camera.cy, 232.0);
    EXPECT_EQ(camera.k1, 0.01);
    EXPECT_EQ(camera.k2, -0.02);
  }
  std::string mm = message;
  mm.replace(mm.find("K: [612.0"), 9, "K: [3.6");
  EXPECT_THAT(refusal_of(mm), HasSubstr("K: fx 3.6 (expected 128"));
  std::string uncalibrated = message;
  const std::size_t at = uncalibrated.find("K: [");
  uncalibrated.replace(at, uncalibrated.find(']', at) - at, "K: [0, 0, 0, 0, 0, 0, 0, 0, 0");
  EXPECT_THAT(refusal_of(uncalibrated), HasSubstr("K: all 0, as a camera says that was never calibrated"));
}

TEST_F(CameraFile, TakesTheNamesOfOldOpenCvFiles) {
  std::string old = kOpenCv;
  for (const auto& [from, to] :
       {std::pair{"image_width", "image_Width"}, std::pair{"image_height", "image_Height"},
        std::pair{"camera_matrix", "Camera_Matrix"},
        std::pair{"distortion_coefficients", "Distortion_Coefficients"}})
    old.replace(old.find(from), std::string(from).size(), to);
  const CameraModel camera = read(old);
  EXPECT_EQ(camera.width_px, 1280);
  EXPECT_EQ(camera.fx, 900.25);
  EXPECT_EQ(camera.k1, -0.25);
}

TEST_F(CameraFile, OfPublicReportsAreTakenOrRefusedAsTheyShould) {
  HEEL_NEEDS_TEST_DATA("reports");
  const std::string reports = test::data_path("reports/");
  int taken = 0, refused = 0;
  for (const auto& entry : std::filesystem::directory_iterator(reports + "camera-file-from-ros")) {
    const CameraModel camera = read_camera_model(entry.path().string());
    EXPECT_EQ(camera.fx, 612.0) << entry.path();
    EXPECT_EQ(camera.lens, LensModel::PlumbBob) << entry.path();
    ++taken;
  }
  for (const auto& entry : std::filesystem::directory_iterator(reports + "camera-file-impossible")) {
    EXPECT_THAT(test::complaint_of([&] { read_camera_model(entry.path().string()); }),
                AllOf(HasSubstr("camera_matrix.data: "), HasSubstr("expected")));
    ++refused;
  }
  EXPECT_GE(taken, 4);
  EXPECT_GE(refused, 3);
}

TEST_F(CameraFile, RefusesFilesWithoutKeys) {
  EXPECT_THAT(refusal_of(""), HasSubstr("an empty file (expected a camera file"));
  EXPECT_THAT(refusal_of("just words\n"), HasSubstr("not a camera file"));
  EXPECT_THAT(refusal_of("%YAML:1.0"), HasSubstr("not a camera file"));
  EXPECT_THAT(refusal_of("width: \"\\\n"), Not(HasSubstr("\n"))) << "yaml-cpp quotes the line's end";
  EXPECT_THAT(refusal_of("roi: {x: 0}\n---\n\"\\\x01\""), Not(HasSubstr("\x01")));
  EXPECT_THROW(read_camera_model(folder.file("absent.yaml")), Error);
}

}  // namespace
}  // namespace heel
