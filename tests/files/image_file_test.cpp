// Pictures: one rule of orientation and of depth for every kind, and refusals of what is no whole picture.
#include "files/image_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "files/exif.h"
#include "files/made_picture.h"
#include "files/orientation.h"
#include "support/temporary_folder.h"
#include "support/test_data.h"

namespace heel {
namespace {

using test::read_text;
using test::write_text;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// Brighter to the right, and much brighter below: each turn of it is another picture.
cv::Mat ramp(int depth = CV_8U, double white = 255.0) {
  cv::Mat picture(24, 40, depth);
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      const double value = white * (x + 4.0 * y) / (39 + 4.0 * 23);
      if (depth == CV_8U) picture.at<std::uint8_t>(y, x) = cv::saturate_cast<std::uint8_t>(value);
      if (depth == CV_16S) picture.at<std::int16_t>(y, x) = cv::saturate_cast<std::int16_t>(value);
      if (depth == CV_16U) picture.at<std::uint16_t>(y, x) = cv::saturate_cast<std::uint16_t>(value);
    }
  }
  return picture;
}

class Pictures : public ::testing::Test {
 protected:
  std::string bytes_of(const std::string& ending, const cv::Mat& picture) {
    std::vector<std::uint8_t> bytes;
    cv::imencode(ending, picture, bytes);
    return {bytes.begin(), bytes.end()};
  }
  GreyImage decode(const std::string& bytes) { return decode_grey_image(write_text(path, bytes)); }
  static double difference(const cv::Mat& a, const cv::Mat& b) {
    return a.size() == b.size() ? cv::norm(a, b, cv::NORM_L1) / static_cast<double>(a.total()) : 1e9;
  }

  test::TemporaryFolder folder;
  std::string path = folder.file("picture.bin");
};

TEST_F(Pictures, OfEveryKindAreTurnedAsTheirFileSays) {
  const std::string jpeg = bytes_of(".jpg", ramp()), png = bytes_of(".png", ramp()),
                    webp = bytes_of(".webp", ramp());
  for (int i = 0; i < 16; ++i) {
    const int orientation = 1 + i % 8;
    SCOPED_TRACE(i);
    const std::string exif =
        i < 8 ? exif_block(orientation, orientation % 2 == 0) : exif_block_with_long(orientation);
    const std::string segment = std::string("Exif\0\0", 6) + exif;
    const std::string app1 = std::string("\xff\xe1\0", 3) + static_cast<char>(segment.size() + 2) + segment;
    const std::string extended = "VP8X" + little_endian(10) + std::string("\x08\0\0\0", 4) +
                                 little_endian(39, 3) + little_endian(23, 3);
    const std::string body = "WEBP" + extended + webp.substr(12) + "EXIF" +
                             little_endian(static_cast<std::uint32_t>(exif.size())) + exif;
    const cv::Mat shown = shown_picture(ramp(), orientation);
    for (const std::string& file :
         {jpeg.substr(0, 2) + app1 + jpeg.substr(2),
          png.substr(0, kPngHeaderBytes) + png_chunk("eXIf", exif) + png.substr(kPngHeaderBytes),
          "RIFF" + little_endian(static_cast<std::uint32_t>(body.size())) + body,
          tiff_of(ramp(), orientation), tiff_of(ramp(), orientation, 4)}) {
      const GreyImage image = decode(file);
      ASSERT_FALSE(image.grey.empty()) << file.substr(0, 4) << ": " << image.problem;
      EXPECT_LT(difference(image.grey, shown), 3.0) << file.substr(0, 4);
      EXPECT_TRUE(image.grey.isContinuous());
    }
  }
}

TEST(Orientation, OfDamagedOrAbsentTagsIsAsStored) {
  const std::string exif = exif_block(6);
  for (std::size_t bytes = 0; bytes < exif.size(); ++bytes) {
    const auto* data = reinterpret_cast<const std::uint8_t*>(exif.data());
    const int orientation = read_tiff_tags({data, bytes}).orientation;
    EXPECT_TRUE(orientation == 1 || (orientation == 6 && bytes >= 22)) << bytes;
  }
  const std::string wrong = exif_block(9);
  EXPECT_EQ(read_tiff_tags({reinterpret_cast<const std::uint8_t*>(wrong.data()), wrong.size()}).orientation,
            1);
}

TEST_F(Pictures, OfMoreBitsFillTheEightByTheDepthThatTheyHave) {
  struct Row {
    double white;
    const char* note;
  };
  for (const Row& row : {Row{1023, "10 are used"}, Row{4095, "12 are used"}, Row{16383, "14 are used"},
                         Row{65535, ""}, Row{4095 * 16, ""}}) {
    const cv::Mat deep = ramp(CV_16U, row.white);
    for (const std::string& file : {bytes_of(".png", deep), tiff_of(deep, 1), bytes_of(".pgm", deep)}) {
      const GreyImage image = decode(file);
      SCOPED_TRACE(std::to_string(row.white) + " " + file.substr(1, 3));
      ASSERT_FALSE(image.grey.empty()) << image.problem;
      const bool says_white = file.starts_with("P5");  // 65535, in its header
      if (!says_white || *row.note == '\0') {
        EXPECT_LT(difference(image.grey, ramp()), 0.6);
        EXPECT_THAT(image.note, HasSubstr(row.note));
      }
    }
  }
}

TEST_F(Pictures, StatedDepthsAreTaken) {
  // The header of a PGM file and the sBIT chunk of a PNG file name the white of a picture that has none.
  const cv::Mat dim = ramp(CV_16U, 900);
  std::string pgm = "P5 # made by a camera\n40 24\n4095\n", png = bytes_of(".png", dim);
  for (int i = 0; i < static_cast<int>(dim.total()); ++i) {
    const auto value = dim.at<std::uint16_t>(i / dim.cols, i % dim.cols);
    pgm += {static_cast<char>(value >> 8), static_cast<char>(value & 0xff)};
  }
  png.insert(kPngHeaderBytes, png_chunk("sBIT", "\x0c"));
  for (const std::string& file : {pgm, png}) {
    const GreyImage image = decode(file);
    ASSERT_FALSE(image.grey.empty()) << image.problem;
    EXPECT_EQ(image.white, 4095);
    EXPECT_THAT(image.note, HasSubstr("12 are used (largest value 900); white is 4095"));
    EXPECT_LT(difference(image.grey, ramp(CV_8U, 255.0 * 900 / 4095)), 0.6);
  }
  const GreyImage four_bits = decode("P2\n2 1\n15\n0 15\n");
  ASSERT_FALSE(four_bits.grey.empty());
  EXPECT_EQ(four_bits.grey.at<std::uint8_t>(0, 1), 255);
}

/// Values that a sensor's driver sets where a pixel is broken.
TEST_F(Pictures, OfMoreBitsWithAHotPixelAreNotTakenForDeeperOnes) {
  for (const int hot : {65535, 8191}) {
    cv::Mat deep = ramp(CV_16U, 4000);
    deep.at<std::uint16_t>(7, 11) = static_cast<std::uint16_t>(hot);
    const GreyImage image = decode(bytes_of(".png", deep));
    EXPECT_EQ(image.white, 4095);
    EXPECT_THAT(image.note, HasSubstr("12 are used (largest value 4000, but for 1 hot)"));
    EXPECT_EQ(image.grey.at<std::uint8_t>(7, 11), 255);
    deep.at<std::uint16_t>(8, 11) = deep.at<std::uint16_t>(8, 12) = static_cast<std::uint16_t>(hot);
    EXPECT_GT(decode(bytes_of(".png", deep)).white, 4095) << "three of 960 pixels are a lamp";
  }
}

TEST_F(Pictures, OfASequenceKeepTheWhiteOfABrighterOne) {
  const std::string dark = write_text(path, bytes_of(".png", ramp(CV_16U, 900)));
  EXPECT_EQ(decode_grey_image(dark).white, 1023);
  EXPECT_EQ(decode_grey_image(dark, 4095).white, 4095);
}

TEST_F(Pictures, CutAnywhereAreRefusedWithoutALineOfALibrary) {
  cv::Mat noisy(96, 128, CV_8U);
  cv::randu(noisy, 0, 255);
  for (const char* ending : {".jpg", ".png", ".bmp", ".pgm", ".webp", ".tif"}) {
    const std::string whole = bytes_of(ending, noisy);
    ASSERT_FALSE(decode(whole).grey.empty()) << ending;
    for (const double share : {0.0, 0.001, 0.02, 0.3, 0.6, 0.95}) {
      const auto bytes = static_cast<std::size_t>(share * static_cast<double>(whole.size()));
      ::testing::internal::CaptureStderr();
      const GreyImage image = decode(whole.substr(0, bytes));
      EXPECT_EQ(::testing::internal::GetCapturedStderr(), "") << ending << " " << share;
      EXPECT_TRUE(image.grey.empty()) << ending << " " << share;
      EXPECT_THAT(image.problem, AllOf(HasSubstr("expected"), Not(HasSubstr("\n"))))
          << ending << " " << share;
    }
  }
}

TEST_F(Pictures, WithoutTheEndMarkerOfTheJpegSayThatItIsMissing) {
  const std::string whole = bytes_of(".jpg", ramp());
  EXPECT_EQ(decode(whole).missing, "");
  const GreyImage image = decode(whole.substr(0, whole.size() - 2));
  EXPECT_EQ(difference(image.grey, decode(whole).grey), 0.0);
  EXPECT_THAT(image.missing, HasSubstr("its end is missing"));
}

/// The last 12 bytes of a PNG say that it ends, those before them are the sum of its last pixels.
TEST_F(Pictures, WithoutTheEndOfThePngSayThatItIsMissing) {
  const std::string whole = bytes_of(".png", ramp());
  EXPECT_EQ(decode(whole).missing, "");
  for (const std::size_t cut : {1u, 8u, 12u}) {
    const GreyImage image = decode(whole.substr(0, whole.size() - cut));
    ASSERT_FALSE(image.grey.empty()) << cut << image.problem;
    EXPECT_EQ(difference(image.grey, ramp()), 0.0);
    EXPECT_THAT(image.missing, HasSubstr("its end is missing"));
  }
  std::string damaged = whole;
  damaged[whole.size() - 14] = static_cast<char>(damaged[whole.size() - 14] ^ 1);
  EXPECT_TRUE(decode(damaged).grey.empty()) << "the sum is wrong";
  EXPECT_TRUE(decode(whole.substr(0, whole.size() - 40)).grey.empty());
}

TEST_F(Pictures, OfTextAreReadWithoutALineEndAfterTheLastNumber) {
  const std::string text = "P2\n# x\n3 2\n255\n0 50 100\n150 200 250";
  const cv::Mat expected = (cv::Mat_<std::uint8_t>(2, 3) << 0, 50, 100, 150, 200, 250);
  for (const std::string& file : {text, text + "\n"}) {
    const GreyImage image = decode(file);
    ASSERT_EQ(image.grey.size(), expected.size()) << image.problem;
    EXPECT_EQ(difference(image.grey, expected), 0.0);
  }
  EXPECT_TRUE(decode(text.substr(0, text.size() - 4)).grey.empty()) << "a number is missing";
}

TEST_F(Pictures, ThatAreTextAreSaidToBe) {
  EXPECT_THAT(decode("data:image/jpeg;base64,/9j/4AAQSkZJRgABAQ").problem,
              HasSubstr("it is text (expected PNG"));
}

/// OpenCV's reader of DICOM files ends the program at an assertion in some of them.
TEST_F(Pictures, OfUnknownKindsAreNotGivenToOpenCv) {
  const std::string dicom = std::string(128, '\0') + "DICM\xff" + "FFFOBFF?\x0e" + std::string(40, '\0');
  EXPECT_THAT(decode(dicom).problem, HasSubstr("not a whole image"));
  EXPECT_FALSE(is_image_file(path));
}

TEST_F(Pictures, OfKindsThatAreNotReadAreNamed) {
  const std::vector<std::pair<std::string, std::string>> rows{
      {std::string("\0\0\0\x18", 4) + "ftypheic" + std::string(20, '\0'), "a HEIC file"},
      {std::string("\0\0\0\x18", 4) + "ftypmif1" + std::string(20, '\0'), "a HEIC file"},
      {std::string("\0\0\0\x18", 4) + "ftypavif" + std::string(20, '\0'), "an AVIF file"},
      {"GIF89a" + std::string(20, '\0'), "a GIF file"},
      {"RIFF" + little_endian(60) + "WEBPVP8X" + little_endian(10) + "\x02" + std::string(20, '\0'),
       "an animated WebP file"},
      {"II\x2b" + std::string(30, '\0'), "a BigTIFF file"},
      {"\x76\x2f\x31\x01" + std::string(30, '\0'), "an OpenEXR file"},
      {"8BPS" + std::string(30, '\0'), "a Photoshop file"},
  };
  for (const auto& [bytes, kind] : rows) {
    EXPECT_THAT(decode(bytes).problem, AllOf(HasSubstr(kind), HasSubstr("JPEG or PNG")));
    EXPECT_TRUE(is_image_file(path)) << kind;
  }
}

TEST_F(Pictures, ThatAreVideosAreNamed) {
  path = folder.file("walk.png");
  const std::vector<std::pair<std::string, std::string>> rows{
      {"\x1a\x45\xdf\xa3" + std::string(20, '\0'), "a Matroska or WebM video"},
      {std::string("\0\0\0\x18", 4) + "ftypisom" + std::string(20, '\0'), "an MP4 or MOV video"},
      {"RIFF" + little_endian(60) + "AVI LIST" + std::string(20, '\0'), "an AVI video"},
  };
  for (const auto& [bytes, kind] : rows)
    EXPECT_THAT(decode(bytes).problem, HasSubstr(kind + " with a picture's name: rename it"));
}

TEST_F(Pictures, OfDeeperPixelsThanAreReadSayWhatTheyHave) {
  cv::Mat floats, numbers;
  ramp().convertTo(floats, CV_32F, 1.0 / 255.0);
  ramp().convertTo(numbers, CV_32S);
  EXPECT_THAT(decode(tiff_of(ramp(CV_16S, 900), 1)).problem, HasSubstr("signed numbers (expected PNG"));
  EXPECT_THAT(decode(tiff_of(floats, 1)).problem, HasSubstr("floating-point numbers (expected PNG"));
  EXPECT_THAT(decode(tiff_of(numbers, 1)).problem, HasSubstr("more than 16 bits (expected PNG"));
}

/// One brightness, written in every way that PNG has for it.
TEST_F(Pictures, OfEveryKindOfPngPixelsHaveTheirGrey) {
  const std::string palette = png_chunk("PLTE", std::string("\0\0\0\x78\x78\x78", 6)),
                    clear = png_chunk("tRNS", std::string("\xff\0", 2));
  std::string grey_alpha, grey_alpha_16, grey_16, colour_alpha, colour_16, indices;
  for (int i = 0; i < 12; ++i) {
    grey_alpha += "\x78\x40";
    grey_alpha_16 += "\x78\x78\x40\x40";
    grey_16 += "\x78\x78";
    colour_alpha += std::string("\x78\x78\x78\0", 4);
    colour_16 += "\x78\x78\x78\x78\x78\x78";
    indices += '\x01';
  }
  for (const std::string& file :
       {png_of(4, 3, 8, 4, grey_alpha), png_of(4, 3, 16, 4, grey_alpha_16), png_of(4, 3, 16, 0, grey_16),
        png_of(4, 3, 8, 6, colour_alpha), png_of(4, 3, 16, 2, colour_16),
        png_of(4, 3, 8, 3, indices, palette), png_of(4, 3, 8, 3, indices, palette + clear)}) {
    const GreyImage image = decode(file);
    ASSERT_EQ(image.grey.size(), cv::Size(4, 3)) << image.problem;
    EXPECT_NEAR(image.grey.at<std::uint8_t>(1, 1), 0x78, 1)
        << static_cast<int>(file[24]) << static_cast<int>(file[25]);
  }
}

TEST_F(Pictures, OfProgressiveJpegsAreThoseOfOthers) {
  std::vector<std::uint8_t> progressive;
  cv::imencode(".jpg", ramp(), progressive, {cv::IMWRITE_JPEG_PROGRESSIVE, 1});
  const GreyImage image = decode({progressive.begin(), progressive.end()});
  ASSERT_FALSE(image.grey.empty()) << image.problem;
  EXPECT_LT(difference(image.grey, ramp()), 3.0);
}

TEST_F(Pictures, OfPublicReportsAreRight) {
  HEEL_NEEDS_TEST_DATA("reports");
  const std::string reports = test::data_path("reports/");
  const cv::Mat reference = read_grey_image(reports + "common/ref.jpg").grey;
  cv::Mat turned;
  cv::rotate(reference, turned, cv::ROTATE_180);
  EXPECT_LT(difference(read_grey_image(reports + "photo-exif/exif3.jpg").grey, turned), 1e-9);
  EXPECT_TRUE(decode_grey_image(reports + "jpeg-cut-short/cut.jpg").grey.empty());
  const GreyImage deep = decode_grey_image(reports + "picture-12-bit/mono12_in16.png");
  EXPECT_EQ(deep.white, 4095);
  const cv::Mat clean = read_grey_image(reports + "mjpeg-harmless-warnings/mj_clean.jpg").grey;
  for (const char* name : {"mj_extraneous_eoi.jpg", "mj_extraneous_rst.jpg"})
    EXPECT_EQ(difference(read_grey_image(reports + "mjpeg-harmless-warnings/" + name).grey, clean), 0.0)
        << name;
  EXPECT_TRUE(decode_grey_image(reports + "mjpeg-harmless-warnings/truly_cut.jpg").grey.empty());
  EXPECT_THAT(decode_grey_image(reports + "small-messages/fake.heic").problem, HasSubstr("a HEIC file"));
}

}  // namespace
}  // namespace heel
