// Camera addresses and the factory: what is accepted, and the messages for wrong ones.
#include "capture/factory/source_address.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "capture/factory/frame_source_factory.h"
#include "capture/frame_source.h"
#include "heel/error.h"
#include "support/complaint.h"

namespace heel {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string complaint_about(const std::string& address) {
  return test::complaint_of([&] { parse_source_address(address); });
}

TEST(SourceAddress, IsSplitIntoKindAndRest) {
  const SourceAddress v4l2 = parse_source_address("v4l2:/dev/video0");
  EXPECT_EQ(v4l2.kind, SourceKind::V4l2);
  EXPECT_EQ(v4l2.rest, "/dev/video0");
  EXPECT_EQ(parse_source_address("sim:yard").kind, SourceKind::Sim);
  EXPECT_EQ(parse_source_address("file:a b.mp4").rest, "a b.mp4");
  const SourceAddress libcamera = parse_source_address("libcamera:/base/soc/i2c0mux/imx219@10");
  EXPECT_EQ(libcamera.kind, SourceKind::Libcamera);
  EXPECT_EQ(parse_source_address("file:C:/odd:name").rest, "C:/odd:name") << "only the first colon counts";
}

TEST(SourceAddress, WrongAddressesAreNamedWithWhatIsExpected) {
  EXPECT_THAT(complaint_about("/dev/video0"),
              AllOf(HasSubstr("'/dev/video0'"), HasSubstr("expected v4l2:PATH")));
  EXPECT_THAT(complaint_about("usb:0"), AllOf(HasSubstr("unknown kind 'usb'"), HasSubstr("sim:NAME")));
  EXPECT_THAT(complaint_about("rtsp://10.0.0.2/stream"), HasSubstr("no stream from a network"));
  EXPECT_THAT(complaint_about("file:"), HasSubstr("nothing after the colon"));
  EXPECT_THAT(complaint_about(""), HasSubstr("no kind before a colon"));
}

TEST(FrameSourceFactory, OpeningAMissingCameraGivesOneLineThatNamesIt) {
  CameraConfig config;
  config.source = "file:/nowhere/at/all.mp4";
  EXPECT_THAT(test::complaint_of([&] { open_frame_source(config); }),
              AllOf(HasSubstr("file:/nowhere/at/all.mp4"), HasSubstr("no such file")));
  config.source = "sim:no-such-simulator";
  EXPECT_THROW(open_frame_source(config), Error);
  config.source = "sim:a/b";
  EXPECT_THROW(make_frame_source(config), Error);
}

TEST(FrameSourceFactory, AMissingLibcameraCameraIsNamed) {
  CameraConfig config;
  config.source = "libcamera:no such camera";
  EXPECT_THAT(test::complaint_of([&] { open_frame_source(config); }),
              AllOf(HasSubstr("libcamera:no such camera"),
                    testing::AnyOf(HasSubstr("knows no camera of this id; it knows"),
                                   HasSubstr("built without libcamera"))));
}

}  // namespace
}  // namespace heel
