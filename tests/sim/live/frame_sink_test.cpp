// "file:PICTURE.pgm": the newest frame as a file, never half of one.
#include "sim/live/frame_sink.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "sim/live/small_frame.h"
#include "support/complaint.h"
#include "support/temporary_folder.h"

namespace heel::sim {
namespace {

TEST(FrameSink, TheFileIsTheNewestFrame) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("now.pgm");
  const auto sink = open_frame_sink("file:" + path, 4, 2, 30.0);
  EXPECT_FALSE(std::filesystem::exists(path)) << "nothing to see before the first frame";
  for (const std::uint8_t level : {std::uint8_t{10}, std::uint8_t{200}}) {
    const std::vector<std::uint8_t> grey(8, level);
    sink->put(test::small_frame(grey));
    EXPECT_EQ(test::read_text(path).substr(0, 2), "P5") << "a binary PGM, which anybody reads";
    const cv::Mat read = cv::imread(path, cv::IMREAD_UNCHANGED);
    ASSERT_EQ(read.type(), CV_8UC1);
    ASSERT_EQ(read.size(), cv::Size(4, 2));
    EXPECT_EQ(cv::countNonZero(read != level), 0);
  }
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1)
      << "nothing is left beside it";
}

TEST(FrameSink, SaysWhatItCannotDo) {
  const std::vector<std::uint8_t> black(8);
  const auto complaint = [&](const std::string& address) {
    return test::complaint_of([&] { open_frame_sink(address, 4, 2, 30.0)->put(test::small_frame(black)); });
  };
  EXPECT_EQ(complaint("file:now.png"), "--camera file:now.png (expected file:PICTURE.pgm)");
  EXPECT_NE(complaint("file:/nowhere/now.pgm").find("/nowhere/now.pgm"), std::string::npos);
  EXPECT_NE(complaint("libcamera:x").find("expected sim:NAME"), std::string::npos);
}

}  // namespace
}  // namespace heel::sim
