// Setting up a device: what is chosen, what is set, and the message of each refusal.
#include "capture/v4l2/v4l2_setup.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "capture/v4l2/scripted_v4l2_device.h"

namespace heel {
namespace {

using test::ScriptedCamera;
using test::ScriptedControl;
using test::ScriptedV4l2Device;
using testing::AllOf;
using testing::HasSubstr;

class V4l2SetupTest : public testing::Test {
 protected:
  V4l2SetupTest() {
    config_.width_px = 8;
    config_.height_px = 4;
    config_.rate_hz = 30.0;
  }
  V4l2Setup set_up() {
    ScriptedV4l2Device device(camera_);
    return set_up_device(device, config_);
  }
  void expect_refused(const std::string& part, const std::string& other = "") {
    const V4l2Setup setup = set_up();
    EXPECT_FALSE(setup.complete);
    EXPECT_THAT(setup.problem, AllOf(HasSubstr(part), HasSubstr(other)));
  }

  ScriptedCamera camera_;
  CameraConfig config_;
};

TEST_F(V4l2SetupTest, FormatSizeStrideAndRateAreWhatTheDeviceSays) {
  camera_.padding = 6;
  const V4l2Setup setup = set_up();
  ASSERT_TRUE(setup.complete) << setup.problem;
  EXPECT_EQ(setup.card, "Scripted camera");
  EXPECT_EQ(setup.format, PixelFormat::Yuyv);
  EXPECT_EQ(setup.width_px, 8u);
  EXPECT_EQ(setup.height_px, 4u);
  EXPECT_EQ(setup.stride_bytes, 22u);
  EXPECT_NEAR(setup.rate_hz, 30.0, 1e-9) << "not the driver's default of 5 Hz";
  EXPECT_NEAR(camera_.rate_hz, 30.0, 1e-9);
}

TEST_F(V4l2SetupTest, AutoTakesTheCheapestFormatThatReachesTheRate) {
  camera_.formats = {V4L2_PIX_FMT_MJPEG, V4L2_PIX_FMT_YUYV, V4L2_PIX_FMT_GREY, V4L2_PIX_FMT_NV12};
  EXPECT_EQ(set_up().format, PixelFormat::Grey);
  camera_.fastest_hz = {{V4L2_PIX_FMT_GREY, 10.0}, {V4L2_PIX_FMT_NV12, 25.0}, {V4L2_PIX_FMT_YUYV, 20.0}};
  EXPECT_EQ(set_up().format, PixelFormat::Mjpg);
  camera_.fastest_hz[V4L2_PIX_FMT_MJPEG] = 15.0;
  const V4l2Setup slow = set_up();
  ASSERT_TRUE(slow.complete);
  EXPECT_EQ(slow.format, PixelFormat::Nv12) << "none reaches 30 Hz: the fastest is taken";
  EXPECT_NEAR(slow.rate_hz, 25.0, 1e-9);
  EXPECT_EQ(camera_.format, std::uint32_t{V4L2_PIX_FMT_NV12});
  EXPECT_NEAR(camera_.rate_hz, 25.0, 1e-9) << "the device has the rate of the final choice";
}

TEST_F(V4l2SetupTest, ANamedFormatIsTakenOrRefused) {
  camera_.formats = {V4L2_PIX_FMT_GREY, V4L2_PIX_FMT_YUYV};
  config_.format = "YUYV";
  EXPECT_EQ(set_up().format, PixelFormat::Yuyv);
  config_.format = "MJPG";
  expect_refused("requested 8x4 MJPG", "gives 8x4 GREY");
}

TEST_F(V4l2SetupTest, AnotherSizeThanRequestedIsRefused) {
  config_.width_px = 640;
  config_.height_px = 480;
  expect_refused("requested 640x480 YUYV, the device gives 8x4 YUYV");
}

TEST_F(V4l2SetupTest, MissingCapabilitiesAreRefusedByName) {
  camera_.capabilities = V4L2_CAP_STREAMING | V4L2_CAP_META_CAPTURE;
  expect_refused("does not capture video");
  camera_.capabilities = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_READWRITE;
  expect_refused("no streaming I/O");
  camera_.errors = {{VIDIOC_QUERYCAP, ENOTTY}};
  expect_refused("is not a V4L2 device");
}

TEST_F(V4l2SetupTest, FormatsThatHeelCannotReadAreListed) {
  camera_.formats = {V4L2_PIX_FMT_H264, V4L2_PIX_FMT_SBGGR8};
  expect_refused("offers H264, BA81", "expected one of GREY, NV12, YUYV, RGB3, BGR3, MJPG");
}

TEST_F(V4l2SetupTest, FieldsInOneFrameAreTakenSeparateOnesRefused) {
  camera_.formats = {V4L2_PIX_FMT_YUYV};
  for (const std::uint32_t field :
       {V4L2_FIELD_INTERLACED, V4L2_FIELD_INTERLACED_TB, V4L2_FIELD_INTERLACED_BT}) {
    camera_.field = field;
    const V4l2Setup setup = set_up();
    EXPECT_TRUE(setup.complete) << setup.problem;
    EXPECT_TRUE(setup.interlaced);
  }
  camera_.field = V4L2_FIELD_NONE;
  EXPECT_FALSE(set_up().interlaced);
  for (const std::uint32_t field : {V4L2_FIELD_ALTERNATE, V4L2_FIELD_TOP, V4L2_FIELD_SEQ_TB}) {
    camera_.field = field;
    expect_refused("gives single or separate fields at 8x4 YUYV", "expected whole frames");
  }
}

TEST_F(V4l2SetupTest, ADeviceWhoseRateCannotBeSetKeepsItsOwn) {
  camera_.rate_settable = false;
  const V4l2Setup setup = set_up();
  EXPECT_TRUE(setup.complete);
  EXPECT_NEAR(setup.rate_hz, 5.0, 1e-9);
}

TEST_F(V4l2SetupTest, ControlsAreFixedAndReadBack) {
  camera_.controls = {{V4L2_CID_EXPOSURE_AUTO, {0, 3, 1, V4L2_EXPOSURE_APERTURE_PRIORITY}},
                      {V4L2_CID_EXPOSURE_AUTO_PRIORITY, {0, 1, 1, 1}},
                      {V4L2_CID_EXPOSURE_ABSOLUTE, {3, 2047, 1, 250}},
                      {V4L2_CID_AUTOGAIN, {0, 1, 1, 1}},
                      {V4L2_CID_GAIN, {0, 255, 1, 7}},
                      {V4L2_CID_FOCUS_AUTO, {0, 1, 1, 1}},
                      {V4L2_CID_FOCUS_ABSOLUTE, {0, 250, 5, 0}}};
  config_.exposure_ms = 5.0;
  config_.gain = 20.0;
  config_.focus = 30.0;
  const V4l2Setup setup = set_up();
  ASSERT_TRUE(setup.complete) << setup.problem;
  EXPECT_EQ(camera_.controls[V4L2_CID_EXPOSURE_AUTO].value, V4L2_EXPOSURE_MANUAL);
  EXPECT_EQ(camera_.controls[V4L2_CID_EXPOSURE_AUTO_PRIORITY].value, 0);
  EXPECT_EQ(camera_.controls[V4L2_CID_EXPOSURE_ABSOLUTE].value, 50) << "units of 100 µs";
  EXPECT_EQ(camera_.controls[V4L2_CID_AUTOGAIN].value, 0);
  EXPECT_EQ(camera_.controls[V4L2_CID_GAIN].value, 20);
  EXPECT_EQ(camera_.controls[V4L2_CID_FOCUS_AUTO].value, 0);
  EXPECT_EQ(camera_.controls[V4L2_CID_FOCUS_ABSOLUTE].value, 30);
  EXPECT_NEAR(setup.exposure_s, 0.005, 1e-9);
  EXPECT_EQ(setup.controls, "exposure (ms) 5, gain 20, focus 30");
}

TEST_F(V4l2SetupTest, ControlsThatAreNotConfiguredAreSetToAutomatic) {
  camera_.controls = {{V4L2_CID_EXPOSURE_AUTO, {0, 3, 1, V4L2_EXPOSURE_MANUAL}},
                      {V4L2_CID_AUTOGAIN, {0, 1, 1, 0}},
                      {V4L2_CID_FOCUS_AUTO, {0, 1, 1, 0}}};
  const V4l2Setup setup = set_up();
  EXPECT_TRUE(setup.complete);
  EXPECT_EQ(camera_.controls[V4L2_CID_EXPOSURE_AUTO].value, V4L2_EXPOSURE_APERTURE_PRIORITY);
  EXPECT_EQ(camera_.controls[V4L2_CID_AUTOGAIN].value, 1);
  EXPECT_EQ(camera_.controls[V4L2_CID_FOCUS_AUTO].value, 0) << "-1 does not change the focus";
  EXPECT_EQ(setup.exposure_s, 0.0);
}

TEST_F(V4l2SetupTest, ControlsThatCannotBeFixedAreRefusedByKey) {
  config_.exposure_ms = 5.0;
  expect_refused("camera.exposure_ms = 5: the device has no control", "expected 0 (automatic)");
  camera_.controls[V4L2_CID_EXPOSURE_ABSOLUTE] = {.least = 100, .most = 2000};
  expect_refused("camera.exposure_ms = 5", "goes from 10 to 200");
  camera_.controls[V4L2_CID_EXPOSURE_ABSOLUTE] = {.least = 1, .most = 2000, .value = 333, .stuck = true};
  expect_refused("camera.exposure_ms = 5", "to 33.3 instead");
  config_.exposure_ms = 0.0;
  config_.gain = 300.0;
  camera_.controls[V4L2_CID_GAIN] = {.least = 0, .most = 255};
  expect_refused("camera.gain = 300", "goes from 0 to 255");
  config_.gain = -1.0;
  config_.focus = 10.0;
  expect_refused("camera.focus = 10: the device has no control of its focus");
}

}  // namespace
}  // namespace heel
