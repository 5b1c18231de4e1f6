// Frames into a video device, against a device made of tables; and what is refused, with its words.
#include "sim/live/v4l2_sink.h"

#include <gtest/gtest.h>
#include <linux/videodev2.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <vector>

#include "heel/error.h"
#include "sim/live/small_frame.h"
#include "support/complaint.h"
#include "support/temporary_folder.h"

namespace heel::sim {
namespace {

/// What the device is, and what was done to it; outlives the device that the sink owns.
struct Loopback {
  int open_error = 0;
  int capability_error = 0;
  std::uint32_t capabilities = V4L2_CAP_VIDEO_OUTPUT | V4L2_CAP_READWRITE;
  int format_error = 0;
  std::uint32_t width = 0;          ///< the only one it takes; 0: any
  std::ptrdiff_t write_result = 0;  ///< 0: takes all
  v4l2_pix_format format{};
  double rate_hz = 0.0;
  std::vector<std::vector<std::uint8_t>> frames{};
};

class ScriptedDevice final : public OutputDevice {
 public:
  explicit ScriptedDevice(Loopback& loopback) : loopback_(loopback) {}
  int open(const std::string& /*path*/) override { return loopback_.open_error; }
  int control(unsigned long request, void* argument) override {
    if (request == VIDIOC_QUERYCAP) {
      auto& out = *static_cast<v4l2_capability*>(argument);
      std::memcpy(out.card, "Scripted", 9);
      out.capabilities = loopback_.capabilities;
      return loopback_.capability_error;
    }
    if (request == VIDIOC_S_FMT) {
      auto& format = *static_cast<v4l2_format*>(argument);
      EXPECT_EQ(format.type, static_cast<std::uint32_t>(V4L2_BUF_TYPE_VIDEO_OUTPUT));
      if (loopback_.width != 0) format.fmt.pix.width = loopback_.width;
      loopback_.format = format.fmt.pix;
      return loopback_.format_error;
    }
    if (request == VIDIOC_S_PARM) {
      const v4l2_fract& period = static_cast<v4l2_streamparm*>(argument)->parm.output.timeperframe;
      loopback_.rate_hz = static_cast<double>(period.denominator) / period.numerator;
      return ENOTTY;  // has no rate: no reason to fail
    }
    ADD_FAILURE() << "request " << request;
    return ENOTTY;
  }
  std::ptrdiff_t write(const std::uint8_t* bytes, std::size_t count) override {
    if (loopback_.write_result != 0) return loopback_.write_result;
    loopback_.frames.emplace_back(bytes, bytes + count);
    return static_cast<std::ptrdiff_t>(count);
  }

 private:
  Loopback& loopback_;
};

V4l2Sink open_sink(Loopback& loopback) {
  return V4l2Sink(std::make_unique<ScriptedDevice>(loopback), "/dev/video9", 4, 2, 30.0);
}

std::string complaint(Loopback loopback) {
  return test::complaint_of([&] { open_sink(loopback); });
}

TEST(V4l2Sink, WritesGreyAsYuyvWithoutColour) {
  Loopback loopback;
  V4l2Sink sink = open_sink(loopback);
  EXPECT_EQ(loopback.format.pixelformat, static_cast<std::uint32_t>(V4L2_PIX_FMT_YUYV));
  EXPECT_EQ(loopback.format.width, 4U);
  EXPECT_EQ(loopback.format.sizeimage, 16U);
  EXPECT_EQ(loopback.rate_hz, 30.0);
  const std::vector<std::uint8_t> grey{1, 2, 3, 4, 5, 6, 7, 255};
  sink.put(test::small_frame(grey));
  ASSERT_EQ(loopback.frames.size(), 1U);
  EXPECT_EQ(loopback.frames[0],
            (std::vector<std::uint8_t>{1, 128, 2, 128, 3, 128, 4, 128, 5, 128, 6, 128, 7, 128, 255, 128}));
}

TEST(V4l2Sink, RefusesWhatCannotTakeFrames) {
  EXPECT_EQ(complaint({.open_error = ENOENT}).substr(0, 55),
            "--camera v4l2:/dev/video9: No such file or directory (e");
  EXPECT_NE(complaint({.open_error = ENOENT}).find("v4l2loopback"), std::string::npos);
  EXPECT_NE(complaint({.capability_error = ENOTTY}).find("not a video device"), std::string::npos);
  EXPECT_NE(complaint({.capabilities = V4L2_CAP_VIDEO_CAPTURE}).find("'Scripted' takes no frames"),
            std::string::npos);
  EXPECT_NE(complaint({.format_error = EBUSY}).find("in use with another format"), std::string::npos);
  EXPECT_NE(complaint({.format_error = EINVAL}).find("expected 4 x 2 YUYV"), std::string::npos);
  EXPECT_NE(complaint({.width = 8}).find("gives 8 x 2 instead"), std::string::npos);
}

TEST(V4l2Sink, ADeviceThatGoesAwayIsNamed) {
  Loopback loopback;
  V4l2Sink sink = open_sink(loopback);
  const std::vector<std::uint8_t> grey(8, 9);
  loopback.write_result = -EAGAIN;
  EXPECT_NO_THROW(sink.put(test::small_frame(grey)));
  loopback.write_result = -ENODEV;
  EXPECT_THROW(sink.put(test::small_frame(grey)), Error);
  loopback.write_result = 3;
  EXPECT_THROW(sink.put(test::small_frame(grey)), Error);
}

TEST(V4l2Sink, TheKernelsDeviceLeavesOrdinaryFilesAlone) {
  const test::TemporaryFolder folder;
  const std::string path = test::write_text(folder.file("video0"), "precious");
  EXPECT_THROW(open_frame_sink("v4l2:" + path, 640, 480, 30.0), Error);
  EXPECT_THROW(open_frame_sink("v4l2:/dev/null", 640, 480, 30.0), Error);
  EXPECT_THROW(open_frame_sink("v4l2:" + folder.file("none"), 640, 480, 30.0), Error);
  EXPECT_THROW(open_frame_sink("file:" + path, 640, 480, 30.0), Error);
  EXPECT_EQ(test::read_text(path), "precious");
}

}  // namespace
}  // namespace heel::sim
