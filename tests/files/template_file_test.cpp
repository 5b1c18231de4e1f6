// The template file: a written template is read back equal, and every damaged file is refused.
#include "files/template_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <Eigen/Geometry>
#include <cmath>
#include <filesystem>
#include <random>
#include <string>

#include "heel/error.h"
#include "heel/shirt_template.h"
#include "support/complaint.h"
#include "support/temporary_folder.h"

namespace heel {
namespace {

using test::read_text;
using test::TemporaryFolder;
using test::write_text;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

ShirtTemplate small_template() {
  ShirtTemplate shirt;
  shirt.camera = {.width_px = 24,
                  .height_px = 16,
                  .fx = 30.25,
                  .fy = 30.5,
                  .cx = 11.7,
                  .cy = 7.1,
                  .k1 = -0.1,
                  .k2 = 1.0 / 3.0,
                  .p1 = 1e-4,
                  .p2 = -2e-5,
                  .k3 = 0.07};
  shirt.roi = {.x_px = 3, .y_px = 2, .width_px = 18, .height_px = 12};
  shirt.distance_m = 1.6;
  shirt.yaw_rad = -1.5;
  shirt.oriented = true;
  shirt.max_features = 123;
  std::mt19937 random(5);
  for (int i = 0; i < 24 * 16; ++i) shirt.grey.push_back(static_cast<std::uint8_t>(random()));
  return shirt;
}

ShirtTemplate with_further_views() {
  ShirtTemplate shirt = small_template();
  std::mt19937 random(6);
  for (const double yaw_rad : {0.3, -0.7}) {
    FurtherView& further = shirt.further_views.emplace_back();
    further.R_further_from_ref = Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitY()).toRotationMatrix();
    further.t_over_d = {yaw_rad / 3.0, 0.1, 0.2};
    for (int i = 0; i < 24 * 16; ++i) further.grey.push_back(static_cast<std::uint8_t>(random()));
  }
  return shirt;
}

std::string refusal_of(const std::string& path) {
  return test::complaint_of([&] { read_template(path); });
}

/// A file with `header` as its JSON and a right checksum, so that only the content can be wrong.
std::string with_header(const std::string& file, const std::string& from, const std::string& to) {
  const std::size_t line_end = file.find('\n');
  std::size_t header_bytes = 0;
  std::size_t image_bytes = 0;
  int version = 0;
  sscanf(file.c_str(), "heel-template %d %zu %zu", &version, &header_bytes, &image_bytes);
  std::string header = file.substr(line_end + 1, header_bytes);
  const std::size_t at = header.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  header.replace(at, from.size(), to);
  std::string made = "heel-template " + std::to_string(version) + " " + std::to_string(header.size()) + " " +
                     std::to_string(image_bytes) + "\n" + header +
                     file.substr(line_end + 1 + header_bytes, image_bytes);
  const uLong checksum =
      crc32(0, reinterpret_cast<const Bytef*>(made.data()), static_cast<uInt>(made.size()));
  for (int shift = 0; shift < 32; shift += 8) made += static_cast<char>(checksum >> shift);
  return made;
}

class TemplateFile : public ::testing::Test {
 protected:
  TemporaryFolder folder;
  std::string path = folder.file("shirt.heel");
};

TEST_F(TemplateFile, IsReadBackToTheBit) {
  const ShirtTemplate written = small_template();
  write_template(written, path);
  const ShirtTemplate read = read_template(path);

  EXPECT_EQ(read.grey, written.grey);
  EXPECT_EQ(read.roi.x_px, 3);
  EXPECT_EQ(read.roi.y_px, 2);
  EXPECT_EQ(read.roi.width_px, 18);
  EXPECT_EQ(read.roi.height_px, 12);
  EXPECT_EQ(read.distance_m, 1.6);
  EXPECT_EQ(read.yaw_rad, -1.5);
  EXPECT_TRUE(read.oriented);
  EXPECT_EQ(read.max_features, 123);
  const CameraModel& a = written.camera;
  const CameraModel& b = read.camera;
  EXPECT_EQ(b.width_px, 24);
  EXPECT_EQ(b.height_px, 16);
  EXPECT_EQ(a.fx, b.fx);
  EXPECT_EQ(a.fy, b.fy);
  EXPECT_EQ(a.cx, b.cx);
  EXPECT_EQ(a.cy, b.cy);
  EXPECT_EQ(a.k1, b.k1);
  EXPECT_EQ(a.k2, b.k2);
  EXPECT_EQ(a.p1, b.p1);
  EXPECT_EQ(a.p2, b.p2);
  EXPECT_EQ(a.k3, b.k3);
}

/// The key is that of files of turned pictures, which earlier programs do not turn again.
TEST_F(TemplateFile, KeepsThatItsPictureIsUpright) {
  ShirtTemplate shirt = small_template();
  write_template(shirt, path);
  EXPECT_FALSE(read_template(path).upright);
  shirt.upright = true;
  write_template(shirt, path);
  EXPECT_TRUE(read_template(path).upright);
  EXPECT_NE(read_text(path).find("\"turned\": true"), std::string::npos);
}

TEST_F(TemplateFile, KeepsTheLensOfAnotherModel) {
  for (const LensModel lens : {LensModel::Rational, LensModel::Fisheye}) {
    ShirtTemplate shirt = small_template();
    shirt.camera.lens = lens;
    shirt.camera.k4 = 0.1;
    shirt.camera.k5 = -1.0 / 3.0;
    shirt.camera.k6 = 1e-3;
    write_template(shirt, path);
    const CameraModel kept = read_template(path).camera;
    EXPECT_EQ(kept.lens, lens);
    EXPECT_EQ(kept.k3, 0.07);
    EXPECT_EQ(kept.k4, 0.1);
    EXPECT_EQ(kept.k5, -1.0 / 3.0);
    EXPECT_EQ(kept.k6, 1e-3);
  }
}

TEST_F(TemplateFile, AnOlderFileWithoutYawIsFromBehind) {
  write_template(small_template(), path);
  write_text(path, with_header(read_text(path), "\"yaw_rad\"", "\"not_read\""));
  EXPECT_EQ(read_template(path).yaw_rad, 0.0);
}

TEST_F(TemplateFile, AYawBeyondHalfATurnIsRefused) {
  ShirtTemplate shirt = small_template();
  shirt.yaw_rad = 4.0;
  EXPECT_THAT(test::complaint_of([&] { write_template(shirt, path); }), HasSubstr("yaw_rad: expected"));
}

TEST_F(TemplateFile, ReplacesAnOlderFileAndLeavesNoOtherFile) {
  write_template(small_template(), path);
  ShirtTemplate newer = small_template();
  newer.distance_m = 2.5;
  write_template(newer, path);
  EXPECT_EQ(read_template(path).distance_m, 2.5);
  const auto files = std::filesystem::directory_iterator(folder.path());
  EXPECT_EQ(std::distance(begin(files), end(files)), 1);
}

TEST_F(TemplateFile, AFailedWriteKeepsTheOldFile) {
  write_template(small_template(), path);
  const std::string before = read_text(path);
  ShirtTemplate wrong = small_template();
  wrong.grey.pop_back();
  EXPECT_THROW(write_template(wrong, path), Error);
  EXPECT_EQ(read_text(path), before);
  EXPECT_THROW(write_template(small_template(), folder.file("no/such/folder.heel")), Error);
}

TEST_F(TemplateFile, RefusesEveryTruncation) {
  write_template(small_template(), path);
  const std::string whole = read_text(path);
  for (std::size_t length = 0; length < whole.size(); ++length) {
    write_text(path, whole.substr(0, length));
    const std::string refusal = refusal_of(path);
    ASSERT_THAT(refusal, HasSubstr(path)) << length << " bytes";
    ASSERT_THAT(refusal, length == 0 ? HasSubstr("not a template") : HasSubstr("truncated"))
        << length << " bytes";
  }
}

TEST_F(TemplateFile, RefusesEveryFlippedBit) {
  write_template(small_template(), path);
  const std::string whole = read_text(path);
  for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    std::string damaged = whole;
    damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ (1 << (bit % 8)));
    write_text(path, damaged);
    const std::string refusal = refusal_of(path);
    ASSERT_THAT(refusal, HasSubstr(path)) << "bit " << bit;
    ASSERT_THAT(refusal, Not(HasSubstr("\n"))) << "bit " << bit;
  }
}

TEST_F(TemplateFile, RefusesBytesAfterTheEnd) {
  write_template(small_template(), path);
  write_text(path, read_text(path) + "x");
  EXPECT_THAT(refusal_of(path), HasSubstr("bytes (expected"));
}

TEST_F(TemplateFile, NamesANewerVersion) {
  write_text(path, "heel-template 3 0 0\nsomething else altogether");
  EXPECT_THAT(refusal_of(path), HasSubstr("format version 3"));
  write_text(path, "heel-template 0 0 0\nsomething else altogether");
  EXPECT_THAT(refusal_of(path), HasSubstr("format version 0"));
}

TEST_F(TemplateFile, FurtherViewsAreReadBackToTheBit) {
  const ShirtTemplate written = with_further_views();
  write_template(written, path);
  EXPECT_THAT(read_text(path), StartsWith("heel-template 2 "));
  const ShirtTemplate read = read_template(path);
  EXPECT_EQ(read.grey, written.grey);
  ASSERT_EQ(read.further_views.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(read.further_views[i].grey, written.further_views[i].grey);
    EXPECT_EQ(read.further_views[i].R_further_from_ref, written.further_views[i].R_further_from_ref);
    EXPECT_EQ(read.further_views[i].t_over_d, written.further_views[i].t_over_d);
  }
}

TEST_F(TemplateFile, WithoutFurtherViewsItIsAFileThatEarlierProgramsRead) {
  write_template(small_template(), path);
  EXPECT_THAT(read_text(path), StartsWith("heel-template 1 "));
  EXPECT_THAT(read_text(path), Not(HasSubstr("further_views")));
}

TEST_F(TemplateFile, ChecksTheFurtherViews) {
  const auto refusal_to_write = [&](const ShirtTemplate& shirt) {
    return test::complaint_of([&] { write_template(shirt, path); });
  };
  ShirtTemplate shirt = with_further_views();
  shirt.further_views[1].R_further_from_ref(0, 0) += 0.01;
  EXPECT_THAT(refusal_to_write(shirt), HasSubstr("expected a rotation"));
  shirt = with_further_views();
  shirt.further_views[0].t_over_d.x() = NAN;
  EXPECT_THAT(refusal_to_write(shirt), HasSubstr("t_over_d"));
  shirt = with_further_views();
  shirt.further_views[0].grey.pop_back();
  EXPECT_THAT(refusal_to_write(shirt), HasSubstr("pictures of the camera's size"));
  shirt = with_further_views();
  shirt.further_views.resize(kMaxFurtherViews + 1, shirt.further_views[0]);
  EXPECT_THAT(refusal_to_write(shirt), HasSubstr("at most 8"));

  write_template(with_further_views(), path);
  const std::string whole = read_text(path);
  write_text(path, with_header(whole, "\"image_bytes\": ", "\"image_bytes\": 99"));
  EXPECT_THAT(refusal_of(path), HasSubstr("image_bytes"));
  write_text(path, with_header(whole, "\"image_bytes\": ", "\"image_bytes\": -"));
  EXPECT_THAT(refusal_of(path), HasSubstr("image"));
  write_text(path, with_header(whole, "\"t_over_d\": [", "\"t_over_d\": [1.0,"));
  EXPECT_THAT(refusal_of(path), HasSubstr("t_over_d: expected 3 numbers"));
}

TEST_F(TemplateFile, RefusesFilesThatAreNotTemplates) {
  write_text(path, "\x89PNG\r\n");
  EXPECT_THAT(refusal_of(path), HasSubstr("not a template"));
  EXPECT_THAT(refusal_of(folder.file("absent.heel")), HasSubstr("No such file"));
  EXPECT_THAT(refusal_of(folder.path().string()), HasSubstr("expected a regular file"));
}

struct WrongHeader {
  const char* from;
  const char* to;
  const char* complaint;
};

TEST_F(TemplateFile, ChecksTheValuesOfTheHeader) {
  const WrongHeader rows[] = {
      {"\"region\"", "\"regiom\"", "region"},
      {"\"fx\": 30.25", "\"fx\": \"wide\"", "header"},
      {"\"fx\": 30.25", "\"fx\": -1", "camera.fx"},
      {"\"fx\": 30.25", "\"fx\": 1e999", "header"},
      {"\"x_px\": 3", "\"x_px\": 7", "region"},
      {"\"width_px\": 18", "\"width_px\": 2147483647", "region"},
      {"\"distance_m\": 1.6", "\"distance_m\": -1.6", "distance_m"},
      {"\"max_features\": 123", "\"max_features\": 0", "max_features"},
      {"\"height_px\": 16", "\"height_px\": 17", "image"},
      {"\"height_px\": 16", "\"height_px\": 99999999", "image"},
      {"{", "[", "header"},
  };
  write_template(small_template(), path);
  const std::string whole = read_text(path);
  ASSERT_EQ(with_header(whole, "1.6", "1.6"), whole);  // with_header() itself changes nothing else
  for (const WrongHeader& row : rows) {
    write_text(path, with_header(whole, row.from, row.to));
    EXPECT_THAT(refusal_of(path), HasSubstr(row.complaint)) << row.to;
  }
}

}  // namespace
}  // namespace heel
