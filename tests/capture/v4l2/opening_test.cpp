// What opening a scripted V4L2 device gives: formats, other users of the camera, refusals.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>

#include "capture/v4l2/device_users.h"
#include "capture/v4l2/v4l2_source_fixture.h"
#include "support/process.h"
#include "support/temporary_folder.h"

namespace heel {
namespace {

using test::ScriptedV4l2Device;
using testing::HasSubstr;

using V4l2Opening = test::V4l2SourceTest;

TEST_F(V4l2Opening, FormatsWithoutUsbBandwidthAreLeftOut) {
  camera_.formats = {V4L2_PIX_FMT_GREY, V4L2_PIX_FMT_YUYV, V4L2_PIX_FMT_MJPEG};
  camera_.without_bandwidth = {V4L2_PIX_FMT_GREY, V4L2_PIX_FMT_YUYV};
  V4l2Source source = make();
  ASSERT_EQ(source.open(), OpenResult::Opened) << source.problem();
  EXPECT_EQ(camera_.format, std::uint32_t{V4L2_PIX_FMT_MJPEG});
  EXPECT_THAT(source.description(), HasSubstr("MJPG 8x4"));

  camera_.without_bandwidth.insert(V4L2_PIX_FMT_MJPEG);
  EXPECT_EQ(source.open(), OpenResult::Absent);
  EXPECT_THAT(source.problem(), testing::AllOf(HasSubstr("too little USB bandwidth for 8x4"),
                                               HasSubstr("as GREY, YUYV, MJPG")));
  EXPECT_EQ(camera_.unmapped, camera_.mapped);

  config_.format = "YUYV";
  V4l2Source named = make();
  EXPECT_EQ(named.open(), OpenResult::Absent);
  EXPECT_THAT(named.problem(), HasSubstr("USB bandwidth"));
  EXPECT_EQ(camera_.format, std::uint32_t{V4L2_PIX_FMT_YUYV}) << "a named format is not replaced";
}

TEST_F(V4l2Opening, ThatAnotherProgramUsesTheCameraIsSaidWithItsName) {
  const test::TemporaryFolder folder;
  const std::string path = test::write_text(folder.file("camera"), "");
  const test::Process other({"sleep", "600"});
  EXPECT_EQ(programs_holding(path), "");
  const test::Process holder({"/bin/sh", "-c", "exec 9<" + path + "; exec sleep 600"});
  EXPECT_TRUE(test::eventually([&] { return programs_holding(path).starts_with("sleep (process "); }));
  camera_.errors = {{VIDIOC_S_FMT, EBUSY}};
  V4l2Source source(path, config_, std::make_unique<ScriptedV4l2Device>(camera_));
  EXPECT_EQ(source.open(), OpenResult::Absent);
  EXPECT_THAT(source.problem(), HasSubstr("; in use by sleep (process "));
}

TEST_F(V4l2Opening, OpeningGivesAbsentOrRefusedWithTheReason) {
  V4l2Source source = make();
  camera_.open_error = ENOENT;
  EXPECT_EQ(source.open(), OpenResult::Absent);
  EXPECT_THAT(source.problem(), HasSubstr("v4l2:/dev/scripted: cannot be opened: No such file"));
  camera_.open_error = EACCES;
  EXPECT_EQ(source.open(), OpenResult::Refused);
  EXPECT_THAT(source.problem(), HasSubstr("Permission denied (expected a user of the group video"));
  camera_.open_error = ENOTTY;
  EXPECT_EQ(source.open(), OpenResult::Refused);
  EXPECT_THAT(source.problem(), HasSubstr("is not a device"));
  camera_.open_error = 0;
  camera_.errors = {{VIDIOC_REQBUFS, EBUSY}};
  EXPECT_EQ(source.open(), OpenResult::Absent);
  EXPECT_THAT(source.problem(), HasSubstr("another program is using it"));
  camera_.errors = {{VIDIOC_STREAMON, EINVAL}};
  EXPECT_EQ(source.open(), OpenResult::Absent);
  EXPECT_THAT(source.problem(), HasSubstr("does not start streaming"));
  camera_.errors.clear();
  camera_.most_buffers = 1;
  EXPECT_EQ(source.open(), OpenResult::Refused);
  EXPECT_THAT(source.problem(), HasSubstr("gives 1 buffer(s)"));
  camera_.most_buffers = 3;
  config_.rate_hz = 30.0;
  EXPECT_EQ(source.open(), OpenResult::Opened);
  EXPECT_THAT(source.description(), HasSubstr("Scripted camera, YUYV 8x4 at 30 Hz"));
  EXPECT_EQ(camera_.unmapped, camera_.mapped - 3);
}

TEST_F(V4l2Opening, AFileThatIsNotADeviceIsRefused) {
  V4l2Source file("/etc/hostname", config_);
  EXPECT_EQ(file.open(), OpenResult::Refused);
  EXPECT_THAT(file.problem(), HasSubstr("is not a device"));
  V4l2Source null("/dev/null", config_);
  EXPECT_EQ(null.open(), OpenResult::Refused);
  EXPECT_THAT(null.problem(), HasSubstr("is not a V4L2 device"));
  V4l2Source missing("/dev/heel-no-such-camera", config_);
  EXPECT_EQ(missing.open(), OpenResult::Absent);
}

}  // namespace
}  // namespace heel
