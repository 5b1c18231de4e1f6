// Camera files of programs that write neither ROS' nor OpenCV's keys, or write numbers in their own way.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "files/camera_info.h"
#include "heel/camera_model.h"
#include "support/complaint.h"
#include "support/temporary_folder.h"

namespace heel {
namespace {

using ::testing::HasSubstr;

class CameraSpellings : public ::testing::Test {
 protected:
  CameraModel read(const std::string& text) { return read_camera_model(test::write_text(path_, text)); }
  std::string refusal(const std::string& text) {
    return test::complaint_of([&] { read(text); });
  }

 private:
  test::TemporaryFolder folder_;
  std::string path_ = folder_.file("camera.yaml");
};

const std::string kSize = "image_width: 640\nimage_height: 480\n",
                  kMatrix = "camera_matrix: {data: [600, 0, 320, 0, 601, 240, 0, 0, 1]}\n";

TEST_F(CameraSpellings, NullIsALensWithoutDistortion) {
  for (const char* none :
       {"D: null\n", "D: ~\n", "D:\n", "distortion_coefficients: {rows: 0, cols: 0, data: null}\n"}) {
    const CameraModel camera = read(kSize + kMatrix + none);
    EXPECT_EQ(camera.fx, 600.0) << none;
    EXPECT_EQ(camera.k1, 0.0) << none;
    EXPECT_EQ(camera.lens, LensModel::PlumbBob) << none;
  }
  EXPECT_THAT(refusal(kSize + kMatrix), HasSubstr("distortion_coefficients: missing"));
}

TEST_F(CameraSpellings, WholeNumbersMayBeWrittenAsOthers) {
  const std::string rows =
      "camera_matrix: {rows: 3.0, cols: 3.0, data: [600, 0, 320, 0, 601, 240, 0, 0, 1]}\n"
      "D: []\n";
  const CameraModel camera = read("image_width: 640.0\nimage_height: 4.8e2\n" + rows);
  EXPECT_EQ(camera.width_px, 640);
  EXPECT_EQ(camera.height_px, 480);
  EXPECT_THAT(refusal("image_width: 640.5\nimage_height: 480\n" + rows),
              HasSubstr("'640.5' (expected whole"));
  EXPECT_THAT(refusal("image_width: .nan\nimage_height: 480\n" + rows), HasSubstr("'.nan' (expected whole"));
  EXPECT_THAT(refusal("image_width: 1e12\nimage_height: 480\n" + rows), HasSubstr("(expected whole"));
  EXPECT_THAT(refusal("image_width: 640\nimage_height: 480\nbinning_x: 2.0\n" + rows),
              HasSubstr("binning_x: 2"));
}

/// rs2_intrinsics as programs dump it, and as rs-enumerate-devices prints it.
TEST_F(CameraSpellings, OfRealSenseAreTaken) {
  const std::string values =
      R"("width": 640, "height": 480, "fx": 614.5, "fy": 615, "ppx": 321, "ppy": 238.5)";
  for (
      const std::string& file :
      {"{" + values + R"(, "model": "distortion.brown_conrady", "coeffs": [0.1, -0.2, 0.001, -0.002, 0.05]})",
       "{" + values +
           R"(, "distortion_model": "rs.distortion.brown_conrady", "coeffs": [0.1, -0.2, 0.001, -0.002, 0.05]})",
       "{" + values + R"(, "model": 4, "coeffs": [0.1, -0.2, 0.001, -0.002, 0.05]})",
       std::string(
           "  Width:      \t640\n  Height:     \t480\n  PPX:        \t321\n  PPY:        \t238.5\n"
           "  Fx:         \t614.5\n  Fy:         \t615\n  Distortion: \tBrown Conrady\n"
           "  Coeffs:     \t0.1  \t-0.2  \t0.001  \t-0.002  \t0.05\n  FOV (deg):  \t55.1 x 42.6\n")}) {
    SCOPED_TRACE(file);
    const CameraModel camera = read(file);
    EXPECT_EQ(camera.width_px, 640);
    EXPECT_EQ(camera.fx, 614.5);
    EXPECT_EQ(camera.fy, 615.0);
    EXPECT_EQ(camera.cx, 321.0);
    EXPECT_EQ(camera.cy, 238.5);
    EXPECT_EQ(camera.k1, 0.1);
    EXPECT_EQ(camera.p2, -0.002);
    EXPECT_EQ(camera.k3, 0.05);
  }
}

TEST_F(CameraSpellings, OfRealSenseWithAnotherLensAreTakenWhereItIsTheSame) {
  const std::string values = "width: 640\nheight: 480\nfx: 614.5\nfy: 615\nppx: 321\nppy: 238.5\n";
  EXPECT_EQ(read(values + "model: Inverse Brown Conrady\ncoeffs: [0, 0, 0, 0, 0]\n").k1, 0.0);
  EXPECT_EQ(read(values + "model: Modified Brown Conrady\ncoeffs: [0.1, 0, 0, 0, 0]\n").k1, 0.1);
  EXPECT_EQ(read(values + "model: Kannala Brandt4\ncoeffs: [0.01, 0, 0, 0, 0]\n").lens, LensModel::Fisheye);
  EXPECT_THAT(refusal(values + "model: Inverse Brown Conrady\ncoeffs: [0.1, 0, 0, 0, 0]\n"),
              HasSubstr("calibrate the camera"));
  EXPECT_THAT(refusal(values + "model: Modified Brown Conrady\ncoeffs: [0.1, 0, 0.01, 0, 0]\n"),
              HasSubstr("calibrate the camera"));
  EXPECT_THAT(refusal(values + "model: F-Theta\ncoeffs: [0, 0, 0, 0, 0]\n"), HasSubstr("'f_theta'"));
}

TEST_F(CameraSpellings, OfRealSenseThatAreNotCompleteAreRefused) {
  const std::string size = "width: 640\nheight: 480\n", rest = "ppx: 321\nppy: 238.5\ncoeffs: []\n";
  EXPECT_THAT(refusal(size + "fx: 614\n" + rest), HasSubstr("fy: missing"));
  EXPECT_THAT(refusal(size + "fx: 614\nfy: 615\nppx: 321\ncoeffs: []\n"), HasSubstr("ppy: missing"));
  EXPECT_THAT(refusal(size + "fx: 614\nfy: 615\nppx: 321\nppy: 238\n"), HasSubstr("missing"));
  EXPECT_THAT(refusal(size + "fx: [614, 615]\nfy: 615\n" + rest), HasSubstr("fx: 2 numbers (expected one"));
  EXPECT_THAT(refusal("fx: 614\nfy: 615\n" + rest), HasSubstr("image_width: missing"));
  EXPECT_THAT(refusal(size + "fx: 1.93\nfy: 1.93\n" + rest), HasSubstr("is it in millimetres?"));
}

/// The order that is asked for is that of the lens.
TEST_F(CameraSpellings, FoldsAskForTheOrderOfTheirModel) {
  const std::string head = kSize + "camera_matrix: {data: [400, 0, 320, 0, 400, 240, 0, 0, 1]}\n";
  EXPECT_THAT(refusal(head + "distortion_model: equidistant\n"
                             "D: [-0.6, 0, 0, 0]\n"),
              HasSubstr("is the order k1 k2 k3 k4?"));
  EXPECT_THAT(refusal(head + "distortion_model: plumb_bob\n"
                             "D: [-1.5, 0, 0, 0, 0]\n"),
              HasSubstr("is the order k1 k2 p1 p2 k3?"));
  EXPECT_THAT(refusal(head + "distortion_model: rational_polynomial\n"
                             "D: [-1.5, 0, 0, 0, 0, 0.001, 0, 0]\n"),
              HasSubstr("is the order k1 k2 p1 p2 k3 k4 k5 k6?"));
}

}  // namespace
}  // namespace heel
