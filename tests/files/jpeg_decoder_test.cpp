// JPEG to grey: good images are decoded, bad ones are refused and do no harm.
#include "files/jpeg_decoder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
// libjpeg's header needs <cstdio> before it.
#include <jpeglib.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <random>
#include <string>
#include <vector>

namespace heel {
namespace {

constexpr int kWidth = 83;
constexpr int kHeight = 47;

cv::Mat made_image() {
  cv::Mat image(kHeight, kWidth, CV_8UC3);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const int wave = static_cast<int>(60.0 * std::sin(x * 0.2) * std::cos(y * 0.15));
      image.at<cv::Vec3b>(y, x) =
          cv::Vec3b(static_cast<unsigned char>(128 + wave), static_cast<unsigned char>(100 + wave),
                    static_cast<unsigned char>(140 - wave));
    }
  }
  return image;
}

std::vector<std::uint8_t> made_jpeg() {
  std::vector<std::uint8_t> jpeg;
  cv::imencode(".jpg", made_image(), jpeg, {cv::IMWRITE_JPEG_QUALITY, 95});
  return jpeg;
}

/// Grey, with arithmetic codes in place of Huffman's.
std::vector<std::uint8_t> arithmetic_jpeg() {
  cv::Mat grey;
  cv::cvtColor(made_image(), grey, cv::COLOR_BGR2GRAY);
  jpeg_compress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  unsigned char* bytes = nullptr;
  unsigned long count = 0;
  jpeg_mem_dest(&jpeg, &bytes, &count);
  jpeg.image_width = kWidth;
  jpeg.image_height = kHeight;
  jpeg.input_components = 1;
  jpeg.in_color_space = JCS_GRAYSCALE;
  jpeg_set_defaults(&jpeg);
  jpeg.arith_code = TRUE;
  jpeg_start_compress(&jpeg, TRUE);
  for (int y = 0; y < kHeight; ++y) {
    JSAMPROW row = grey.ptr(y);
    jpeg_write_scanlines(&jpeg, &row, 1);
  }
  jpeg_finish_compress(&jpeg);
  jpeg_destroy_compress(&jpeg);
  std::vector<std::uint8_t> file(bytes, bytes + count);
  std::free(bytes);
  return file;
}

class JpegDecoderTest : public testing::Test {
 protected:
  bool decode(const std::vector<std::uint8_t>& jpeg, std::uint32_t width_px = kWidth) {
    return decoder_.decode(jpeg.data(), jpeg.size(), width_px, kHeight, grey_.data());
  }
  double mean_error() const {
    cv::Mat expected;
    cv::cvtColor(made_image(), expected, cv::COLOR_BGR2GRAY);
    const cv::Mat got(kHeight, kWidth, CV_8UC1, const_cast<std::uint8_t*>(grey_.data()));
    return cv::norm(expected, got, cv::NORM_L1) / (kWidth * kHeight);
  }

  JpegDecoder decoder_;
  std::vector<std::uint8_t> grey_ = std::vector<std::uint8_t>(2 * kWidth * kHeight);
};

TEST_F(JpegDecoderTest, ColourImagesGiveTheirLuma) {
  ASSERT_TRUE(decode(made_jpeg())) << decoder_.problem();
  EXPECT_LT(mean_error(), 1.5);
}

// Motion-JPEG cameras send images without Huffman tables, because they use those of the standard.
TEST_F(JpegDecoderTest, ImagesWithoutHuffmanTablesAreDecodedWithTheStandardOnes) {
  const std::vector<std::uint8_t> jpeg = made_jpeg();
  std::vector<std::uint8_t> bare(jpeg.begin(), jpeg.begin() + 2);
  std::size_t at = 2;
  int removed = 0;
  while (jpeg[at + 1] != 0xda) {  // up to the start of scan
    const std::size_t bytes = 2 + (std::size_t{jpeg[at + 2]} << 8 | jpeg[at + 3]);
    if (jpeg[at + 1] == 0xc4) {
      ++removed;
    } else {
      bare.insert(bare.end(), jpeg.begin() + static_cast<long>(at),
                  jpeg.begin() + static_cast<long>(at + bytes));
    }
    at += bytes;
  }
  ASSERT_GT(removed, 0);
  bare.insert(bare.end(), jpeg.begin() + static_cast<long>(at), jpeg.end());
  ASSERT_TRUE(decode(bare)) << decoder_.problem();
  EXPECT_LT(mean_error(), 1.5);
}

TEST_F(JpegDecoderTest, TruncatedImagesAreRefusedWhereverTheyEnd) {
  const std::vector<std::uint8_t> jpeg = made_jpeg();
  for (std::size_t bytes = 0; bytes + 2 < jpeg.size(); bytes += 1 + bytes / 16) {
    const std::vector<std::uint8_t> part(jpeg.begin(), jpeg.begin() + static_cast<long>(bytes));
    EXPECT_FALSE(decode(part)) << bytes << " of " << jpeg.size() << " bytes";
    EXPECT_STRNE(decoder_.problem(), "") << bytes;
  }
  EXPECT_TRUE(decode(jpeg)) << "the decoder must decode the next image: " << decoder_.problem();
}

// Encoders of cameras leave bytes of padding there.
TEST_F(JpegDecoderTest, AFewBytesTooManyBeforeAMarkerDoNoHarm) {
  std::vector<std::uint8_t> jpeg;
  cv::imencode(".jpg", made_image(), jpeg, {cv::IMWRITE_JPEG_QUALITY, 95, cv::IMWRITE_JPEG_RST_INTERVAL, 2});
  ASSERT_TRUE(decode(jpeg)) << decoder_.problem();
  const std::vector<std::uint8_t> clean = grey_;
  int markers = 0;
  for (std::size_t at = 2; at + 1 < jpeg.size(); ++at) {
    const bool marker =
        jpeg[at] == 0xff && ((jpeg[at + 1] >= 0xd0 && jpeg[at + 1] <= 0xd7) || jpeg[at + 1] == 0xd9);
    if (!marker) continue;
    ++markers;
    for (const std::size_t extra : {1u, 3u, 8u}) {
      std::vector<std::uint8_t> padded = jpeg;
      padded.insert(padded.begin() + static_cast<long>(at), extra, static_cast<std::uint8_t>(0x5a + markers));
      grey_.assign(grey_.size(), 0);
      EXPECT_TRUE(decode(padded)) << extra << " bytes before marker " << markers << ": "
                                  << decoder_.problem();
      EXPECT_EQ(grey_, clean);
    }
    std::vector<std::uint8_t> stuffed = jpeg;
    stuffed.insert(stuffed.begin() + static_cast<long>(at), 40, 0x5a);
    EXPECT_FALSE(decode(stuffed)) << "so many are the rest of a damaged picture";
  }
  EXPECT_GE(markers, 4);
}

// Cameras leave it out, and interrupted downloads.
TEST_F(JpegDecoderTest, AMissingEndMarkerDoesNoHarmWhereEveryRowIsThere) {
  for (const std::vector<int>& settings : {std::vector<int>{cv::IMWRITE_JPEG_QUALITY, 95},
                                           {cv::IMWRITE_JPEG_PROGRESSIVE, 1},
                                           {cv::IMWRITE_JPEG_RST_INTERVAL, 2}}) {
    SCOPED_TRACE(settings.front());
    std::vector<std::uint8_t> jpeg;
    cv::imencode(".jpg", made_image(), jpeg, settings);
    ASSERT_TRUE(decode(jpeg)) << decoder_.problem();
    EXPECT_TRUE(decoder_.has_end());
    const std::vector<std::uint8_t> clean = grey_;
    for (const int missing : {1, 2}) {
      jpeg.pop_back();
      grey_.assign(grey_.size(), 0);
      EXPECT_TRUE(decode(jpeg)) << missing << ": " << decoder_.problem();
      EXPECT_FALSE(decoder_.has_end());
      EXPECT_EQ(grey_, clean);
    }
    jpeg.insert(jpeg.end(), 40, 0);
    EXPECT_FALSE(decode(jpeg)) << "zeros may stand in place of rows";
    jpeg.resize(jpeg.size() - 43);
    EXPECT_FALSE(decode(jpeg)) << "bits of the last block are missing";
    EXPECT_STRNE(decoder_.problem(), "");
  }
}

// Between two scans no bit is missing, only detail: nothing but the end marker says that there is no more of
// it.
TEST_F(JpegDecoderTest, AProgressiveImageThatEndsBetweenItsScansIsRefused) {
  std::vector<std::uint8_t> jpeg;
  cv::imencode(".jpg", made_image(), jpeg, {cv::IMWRITE_JPEG_PROGRESSIVE, 1});
  int scans = 0;
  for (std::size_t at = jpeg.size() / 4; at + 1 < jpeg.size(); ++at) {
    if (jpeg[at] != 0xff || (jpeg[at + 1] != 0xda && jpeg[at + 1] != 0xc4)) continue;
    ++scans;
    const std::vector<std::uint8_t> part(jpeg.begin(), jpeg.begin() + static_cast<long>(at));
    EXPECT_FALSE(decode(part)) << at << " of " << jpeg.size() << " bytes";
  }
  EXPECT_GE(scans, 4);
}

// Their codes go on as zeros where bytes are missing, without a warning of the library.
TEST_F(JpegDecoderTest, ArithmeticCodesNeedTheirEndMarker) {
  std::vector<std::uint8_t> jpeg = arithmetic_jpeg();
  ASSERT_TRUE(decode(jpeg)) << decoder_.problem();
  jpeg.resize(jpeg.size() / 2);
  EXPECT_FALSE(decode(jpeg));
}

TEST_F(JpegDecoderTest, AMissingPieceInTheMiddleIsRefused) {
  std::vector<std::uint8_t> jpeg = made_jpeg();
  const auto middle = jpeg.begin() + static_cast<long>(jpeg.size() / 2);
  jpeg.erase(middle, middle + 200);
  EXPECT_FALSE(decode(jpeg));
  EXPECT_STRNE(decoder_.problem(), "");
}

TEST_F(JpegDecoderTest, AnotherSizeIsRefusedBeforeAnythingIsWritten) {
  grey_.assign(grey_.size(), 0xab);
  EXPECT_FALSE(decode(made_jpeg(), kWidth + 1));
  EXPECT_THAT(decoder_.problem(), testing::HasSubstr("83x47"));
  EXPECT_THAT(grey_, testing::Each(0xab));
}

TEST_F(JpegDecoderTest, DamagedBytesDoNoHarm) {
  const std::vector<std::uint8_t> jpeg = made_jpeg();
  for (unsigned seed = 0; seed < 300; ++seed) {
    std::mt19937 random(seed);
    std::vector<std::uint8_t> damaged = jpeg;
    for (int i = 0; i < 8; ++i) damaged[random() % damaged.size()] = static_cast<std::uint8_t>(random());
    decode(damaged);  // any result is right; the sanitizers check the memory accesses
  }
  EXPECT_TRUE(decode(jpeg));
  EXPECT_LT(mean_error(), 1.5);
}

}  // namespace
}  // namespace heel
