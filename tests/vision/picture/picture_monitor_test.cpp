// What pictures of a made-up room show of themselves, and that pictures of cameras show no fault.
#include "vision/picture/picture_monitor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <numbers>
#include <vector>

#include "files/image_file.h"
#include "files/video_reader.h"
#include "support/allocation_count.h"
#include "support/test_data.h"
#include "vision/picture/made_up_room.h"

namespace heel {
namespace {

using test::Camera;
using test::kHeight;
using test::kWidth;
using test::Light;
using test::Room;
using test::times;

TEST(PictureMonitor, ARoomShowsNoFault) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    for (const double noise : {0.0, 3.0, 8.0}) {
      const Room room(seed, 4.0);
      Camera camera(noise);
      for (const PictureFault fault : camera.see(room.light(), 40))
        ASSERT_EQ(fault, PictureFault::None) << to_string(fault) << ", noise " << noise;
    }
  }
}

TEST(PictureMonitor, ACapOnTheLensIsDarkWithinASecondAndGoneAfterOne) {
  const Room room(1);
  const Light cap = [](double, double, int) { return 4.0; };
  Camera camera;
  EXPECT_EQ(camera.after(room.light(), 0.5), PictureFault::None);
  EXPECT_EQ(camera.after(cap, 0.4), PictureFault::None) << "a moment in the dark is none";
  EXPECT_EQ(camera.after(cap, 0.5), PictureFault::Dark);
  EXPECT_EQ(camera.after(room.light(), 0.3), PictureFault::Dark) << "a moment of light is no end of it";
  EXPECT_EQ(camera.after(room.light(), 0.5), PictureFault::None);
}

TEST(PictureMonitor, ADarkRoomWithALampIsDarkButNotARoomOfWhichMuchIsSeen) {
  const Room room(2);
  const auto darker = [&](double factor) {
    return [&room, factor](double x, double y, int picture) {
      return x > 250 && x < 290 && y < 30 ? 200.0 : factor * room.grey(x, y, picture);
    };
  };
  EXPECT_EQ(Camera().after(darker(0.06), 1.5), PictureFault::Dark);
  EXPECT_EQ(Camera().after(darker(0.15), 1.5), PictureFault::None);
}

TEST(PictureMonitor, LightIntoTheLensIsTooBright) {
  const Light white = [](double, double, int) { return 254.0; };
  Camera camera;
  EXPECT_EQ(camera.after(white, 0.4), PictureFault::None);
  EXPECT_EQ(camera.after(white, 0.5), PictureFault::TooBright);
}

TEST(PictureMonitor, AHandOnTheLensShowsNoDetail) {
  const Room room(3);
  // Light through a finger: bright on one side, and smooth.
  const Light finger = [](double x, double y, int) { return 60.0 + 0.24 * x + 0.1 * y; };
  Camera camera(3.0);
  EXPECT_EQ(camera.after(room.light(), 0.5), PictureFault::None);
  EXPECT_EQ(camera.after(finger, 0.9), PictureFault::None);
  EXPECT_EQ(camera.after(finger, 0.6), PictureFault::NoDetail);
  // A corner of the picture is free.
  const Light most = [&](double x, double y, int picture) {
    return x < 30 && y < 30 ? 220.0 : finger(x, y, picture);
  };
  EXPECT_EQ(Camera(3.0).after(most, 1.5), PictureFault::NoDetail);
}

TEST(PictureMonitor, ALensOutOfFocusIsNamedAfterThreeSeconds) {
  Room room(4);
  room.blur(6);
  Camera camera;
  EXPECT_EQ(camera.after(room.light(), 2.5), PictureFault::None);
  EXPECT_EQ(camera.after(room.light(), 1.0), PictureFault::OutOfFocus);
  Room nearly_sharp(4);
  nearly_sharp.blur(1);
  EXPECT_EQ(camera.after(nearly_sharp.light(), 1.0), PictureFault::None);
}

TEST(PictureMonitor, BandsOfFlickerAreNamedWhereTheyMove) {
  const Room room(5, 3.0);
  for (const double rate_hz : {100.0, 120.0}) {
    // A rolling shutter of 25 ms reads the rows one after the other; 29.8 pictures a second.
    const auto lamp = [&](double y, int picture) {
      const double t_s = picture / 29.8 + 0.025 * y / kHeight;
      return 1.0 + 0.1 * std::sin(2.0 * std::numbers::pi * rate_hz * t_s);
    };
    EXPECT_EQ(Camera().after(times(room.light(), lamp), 3.0),
              rate_hz == 100.0 ? PictureFault::Flicker : PictureFault::None)
        << rate_hz << " Hz: bands that stand still are not seen, and do little harm";
  }
}

TEST(PictureMonitor, AnExposureThatGoesUpAndDownIsNamed) {
  const Room room(6);
  const auto hunting = [](double, int picture) {
    return 1.0 + 0.35 * std::sin(2.0 * std::numbers::pi * picture / 30.0);
  };
  EXPECT_EQ(Camera().after(times(room.light(), hunting), 4.0), PictureFault::ExposureHunting);
  // Out of a dark corridor into the light, once.
  const auto light_once = [](double, int picture) { return picture < 45 ? 0.4 : 1.0; };
  EXPECT_EQ(Camera().after(times(room.light(), light_once), 4.0), PictureFault::None);
}

TEST(PictureMonitor, RowsOfTwoTimesAreInterlaced) {
  const Room room(7, 8.0);
  const Light fields = [&](double x, double y, int picture) {
    return room.grey(x + (static_cast<int>(y) % 2 == 0 ? 0.0 : 4.0), y, picture);
  };
  EXPECT_EQ(Camera().after(fields, 1.0), PictureFault::Interlaced);
  // A shirt with stripes of one pixel is not.
  const Light stripes = [&](double x, double y, int picture) {
    const bool on_shirt = x > 100 && x < 210 && y > 60 && y < 200;
    return on_shirt ? (static_cast<int>(y) % 2 == 0 ? 40.0 : 200.0) : room.grey(x, y, picture);
  };
  EXPECT_EQ(Camera().after(stripes, 1.0), PictureFault::None);
}

TEST(PictureMonitor, StartsAgainAfterAGapAndAllocatesNothing) {
  std::vector<std::uint8_t> black(std::size_t{kWidth} * kHeight, 3);
  FrameView frame;
  frame.header = {1, kNsPerS, kWidth, kHeight};
  frame.grey = black.data();
  frame.stride_bytes = kWidth;
  PictureMonitor monitor;
  monitor.update(frame);
  const std::uint64_t allocations = test::allocations_of_this_thread();
  frame.header.t_capture_ns += 3 * kNsPerS;
  EXPECT_EQ(monitor.update(frame), PictureFault::None) << "half a second of dark is counted from here on";
  frame.header.t_capture_ns += 600 * kNsPerMs;
  EXPECT_EQ(monitor.update(frame), PictureFault::Dark);
  if (test::counts_allocations()) {
    EXPECT_EQ(test::allocations_of_this_thread(), allocations);
  }
}

TEST(PictureMonitor, AFilmOfACameraShowsNoFault) {
  HEEL_NEEDS_TEST_DATA("person/one-by-one.mp4");
  VideoReader video;
  ASSERT_TRUE(video.open(test::data_path("person/one-by-one.mp4"))) << video.problem();
  PictureMonitor monitor;
  int pictures = 0;
  for (cv::Mat grey; video.read(grey); ++pictures) {
    FrameView frame = frame_view_of(grey);
    frame.header.t_capture_ns = kNsPerS + static_cast<TimeNs>(video.time_s() * 1e9);
    ASSERT_EQ(monitor.update(frame), PictureFault::None) << "picture " << pictures;
  }
  EXPECT_EQ(pictures, 1394);
}

// Photographs and pictures of another renderer: sharp ones, in bright and dim light.
TEST(PictureStatistics, OfPhotographsAreFarFromEveryBound) {
  HEEL_NEEDS_TEST_DATA("oxford");
  HEEL_NEEDS_TEST_DATA("foreign/images");
  int pictures = 0;
  for (const char* folder : {"oxford/graf", "oxford/leuven", "foreign/images"}) {
    for (const auto& entry : std::filesystem::directory_iterator(test::data_path(folder))) {
      const std::string extension = entry.path().extension();
      if (extension != ".ppm" && extension != ".jpg" && extension != ".png") continue;
      const GreyImage picture = read_grey_image(entry.path());
      const FrameView view = frame_view_of(picture.grey);
      const PictureBrightness light = picture_brightness(view);
      const PictureEdges edges = picture_edges(view);
      EXPECT_LT(edges.edge_blur_px, 2.0) << entry.path();
      EXPECT_GT(edges.detail, 0.05) << entry.path();
      EXPECT_LT(edges.comb, 0.06) << entry.path();
      EXPECT_GT(light.mean, 20.0) << entry.path();
      ++pictures;
    }
  }
  EXPECT_GT(pictures, 100);
}

}  // namespace
}  // namespace heel
