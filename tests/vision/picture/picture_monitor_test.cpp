// What pictures of a made-up room show of themselves, and that pictures of cameras show no fault.
#include "vision/picture/picture_monitor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include "files/image_file.h"
#include "files/video_reader.h"
#include "support/allocation_count.h"
#include "support/test_data.h"

namespace heel {
namespace {

constexpr int kWidth = 320, kHeight = 240;
constexpr double kRate_hz = 30.0;

/// Grey values of a place and a picture; 0…255 and beyond.
using Light = std::function<double(double x, double y, int picture)>;

/// A room: rectangles of different brightness on a wall, which moves to the left as a robot turns.
class Room {
 public:
  explicit Room(unsigned seed, double speed_px = 2.0) : speed_px_(speed_px) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> x(0.0, 2.0 * kWidth), y(0.0, kHeight), size(10.0, 80.0),
        grey(30.0, 220.0);
    for (int i = 0; i < 160; ++i) {
      const double left = x(random), top = y(random);
      boxes_.push_back({left, top, left + size(random), top + size(random), grey(random)});
    }
    picture_.resize(std::size_t{2 * kWidth} * kHeight, 120.0F);
    for (const Box& box : boxes_)
      for (int row = static_cast<int>(box.top); row < std::min<double>(box.bottom, kHeight); ++row)
        for (int column = static_cast<int>(box.left); column < std::min<double>(box.right, 2 * kWidth);
             ++column)
          picture_[index(column, row)] = static_cast<float>(box.grey);
  }

  double grey(double x, double y, int picture) const {
    const int column = static_cast<int>(x + speed_px_ * picture) % (2 * kWidth);
    return picture_[index(column, static_cast<int>(y))];
  }
  Light light() const {
    return [this](double x, double y, int picture) { return grey(x, y, picture); };
  }

  /// The same through a lens that blurs as a box of 2 `radius_px` + 1 pixels.
  void blur(int radius_px) {
    for (int pass = 0; pass < 2; ++pass) {
      blur_along(radius_px, 1, 2 * kWidth, kHeight, 2 * kWidth);
      blur_along(radius_px, 2 * kWidth, kHeight, 2 * kWidth, 1);
    }
  }

 private:
  struct Box {
    double left, top, right, bottom, grey;
  };
  static std::size_t index(int column, int row) {
    return static_cast<std::size_t>(row) * 2 * kWidth + static_cast<std::size_t>(column);
  }
  void blur_along(int radius, int step, int length, int lines, int line_step) {
    std::vector<float> line(static_cast<std::size_t>(length));
    for (int l = 0; l < lines; ++l) {
      float* first = picture_.data() + static_cast<std::ptrdiff_t>(l) * line_step;
      for (int i = 0; i < length; ++i) {
        float sum = 0.0F;
        for (int k = -radius; k <= radius; ++k)
          sum += first[static_cast<std::ptrdiff_t>(std::clamp(i + k, 0, length - 1)) * step];
        line[static_cast<std::size_t>(i)] = sum / static_cast<float>(2 * radius + 1);
      }
      for (int i = 0; i < length; ++i)
        first[static_cast<std::ptrdiff_t>(i) * step] = line[static_cast<std::size_t>(i)];
    }
  }

  double speed_px_;
  std::vector<Box> boxes_;
  std::vector<float> picture_;
};

/// A camera with noise, and the monitor that sees its pictures.
class Camera {
 public:
  explicit Camera(double noise = 2.0) : noise_(noise) {}

  /// The fault after each of `pictures` pictures.
  std::vector<PictureFault> see(const Light& light, int pictures) {
    std::vector<PictureFault> faults;
    for (int i = 0; i < pictures; ++i, ++picture_) {
      for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
          grey_[static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x)] =
              static_cast<std::uint8_t>(std::clamp(light(x, y, picture_) + noise_ * noise(), 0.0, 255.0));
      faults.push_back(monitor_.update(view()));
    }
    return faults;
  }
  PictureFault after(const Light& light, double seconds) {
    return see(light, static_cast<int>(seconds * kRate_hz)).back();
  }

 private:
  FrameView view() const {
    FrameView frame;
    frame.header.width_px = kWidth;
    frame.header.height_px = kHeight;
    frame.header.t_capture_ns = kNsPerS + static_cast<TimeNs>(picture_ * 1e9 / kRate_hz);
    frame.grey = grey_.data();
    frame.stride_bytes = kWidth;
    return frame;
  }
  /// About normal, and fast.
  double noise() {
    const auto bits = static_cast<std::uint32_t>(random_());
    return (static_cast<double>(bits & 0xff) + (bits >> 8 & 0xff) + (bits >> 16 & 0xff) + (bits >> 24) -
            510.0) /
           148.0;
  }

  double noise_;
  std::mt19937 random_{7};
  PictureMonitor monitor_;
  std::vector<std::uint8_t> grey_ = std::vector<std::uint8_t>(std::size_t{kWidth} * kHeight);
  int picture_ = 0;
};

Light times(const Light& light, const std::function<double(double y, int picture)>& factor) {
  return [=](double x, double y, int picture) { return light(x, y, picture) * factor(y, picture); };
}

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
  EXPECT_EQ(camera.after(room.light(), 0.8), PictureFault::None);
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
  EXPECT_EQ(Camera().after([](double, double, int) { return 254.0; }, 1.0), PictureFault::TooBright);
}

TEST(PictureMonitor, AHandOnTheLensShowsNoDetail) {
  const Room room(3);
  // Light through a finger: bright on one side, and smooth.
  const Light finger = [](double x, double y, int) { return 60.0 + 0.24 * x + 0.1 * y; };
  Camera camera(3.0);
  EXPECT_EQ(camera.after(room.light(), 0.5), PictureFault::None);
  EXPECT_EQ(camera.after(finger, 1.5), PictureFault::NoDetail);
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
      const PictureStatistics shown = picture_statistics(frame_view_of(picture.grey));
      EXPECT_LT(shown.edge_blur_px, 2.0) << entry.path();
      EXPECT_GT(shown.detail, 0.05) << entry.path();
      EXPECT_LT(shown.comb, 0.06) << entry.path();
      EXPECT_GT(shown.mean, 20.0) << entry.path();
      ++pictures;
    }
  }
  EXPECT_GT(pictures, 100);
}

}  // namespace
}  // namespace heel
