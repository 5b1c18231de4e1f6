// Camera files of pixels that are not squares, and other files in the place of a camera file.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "files/camera_info.h"
#include "support/complaint.h"
#include "support/temporary_folder.h"

namespace heel {
namespace {

using test::write_text;
using ::testing::AllOf;
using ::testing::HasSubstr;

class UnusualCameraFile : public ::testing::Test {
 protected:
  std::string refusal_of(const std::string& text) {
    return test::complaint_of([&] { read_camera_model(write_text(path, text)); });
  }

  test::TemporaryFolder folder;
  std::string path = folder.file("camera.yaml");
};

/// The camera matrix with other focal lengths.
std::string with_focal(const std::string& fx, const std::string& fy) {
  return "image_width: 640\nimage_height: 480\ncamera_matrix:\n  rows: 3\n  cols: 3\n  data: [" + fx +
         ", 0, 320, 0, " + fy +
         ", 240, 0, 0, 1]\ndistortion_coefficients:\n  rows: 1\n  cols: 5\n  data: [0, 0, 0, 0, 0]\n";
}

TEST_F(UnusualCameraFile, WithPixelsThatHardlyACameraHasIsTakenWithAWarning) {
  // Square pixels, and analogue video in 720x480 and 720x576, 4:3 and 16:9.
  for (const auto& [fx, fy] : std::vector<std::pair<const char*, const char*>>{
           {"700", "700"}, {"700", "637"}, {"700", "764"}, {"700", "848"}}) {
    const CameraFile file = read_camera_file(write_text(path, with_focal(fx, fy)));
    EXPECT_EQ(file.warning, "") << fy;
  }
  // Squeezed to another shape, both ways; one field of NTSC; half of the columns.
  int warnings = 0;
  for (const auto& [fx, fy] : std::vector<std::pair<const char*, const char*>>{
           {"700", "525"}, {"525", "700"}, {"700", "318"}, {"700", "1400"}}) {
    const CameraFile file = read_camera_file(write_text(path, with_focal(fx, fy)));
    EXPECT_EQ(file.camera.fy, std::stod(fy));
    EXPECT_THAT(file.warning, AllOf(HasSubstr(path + ": camera_matrix.data: fy " + fy),
                                    HasSubstr(std::string("fx ") + fx + " (expected 0.8…1.25 times"),
                                    HasSubstr("squeezed to 640x480")));
    ++warnings;
  }
  EXPECT_EQ(warnings, 4);
}

TEST_F(UnusualCameraFile, WithPixelsThatNoCameraHasIsRefused) {
  for (const auto& [fx, fy] :
       std::vector<std::pair<const char*, const char*>>{{"700", "300"}, {"400", "910"}, {"1500", "650"}})
    EXPECT_THAT(refusal_of(with_focal(fx, fy)), AllOf(HasSubstr(std::string("camera_matrix.data: fy ") + fy +
                                                                " beside fx " + fx + " (expected fy "),
                                                      HasSubstr("was one of them edited?")));
}

TEST_F(UnusualCameraFile, WithACentreFarFromTheMiddleIsWarnedOf) {
  std::string text = with_focal("600", "600");
  EXPECT_EQ(read_camera_file(write_text(path, text)).warning, "");
  // As of a picture on its side.
  text.replace(text.find("0, 320, 0"), 9, "0, 239, 0").replace(text.find("240, 0, 0"), 3, "319");
  EXPECT_THAT(
      read_camera_file(write_text(path, text)).warning,
      AllOf(
          HasSubstr("camera_matrix.data: the centre cx 239, cy 319 is at 37 % of the width and 66 % of the"),
          HasSubstr("were cx and cy exchanged")));
}

TEST_F(UnusualCameraFile, OfAnotherProgramIsNamed) {
  const std::vector<std::pair<std::string, std::string>> rows{
      {"%YAML:1.0\nCamera.fx: 600.0\nCamera.width: 640\n", "Camera.fx: settings of ORB-SLAM"},
      {"%YAML:1.0\nCamera1.fx: 600.0\n", "Camera1.fx: settings of ORB-SLAM"},
      {"image_width: 640\nprojection_parameters: {fx: 600}\n", "a camera file of VINS"},
      {R"({"value0": {"intrinsics": []}})", "a calibration of basalt"},
      {R"({"mtx": [[600,0,320],[0,600,240],[0,0,1]], "dist": [0,0,0,0,0]})",
       "without the size of the picture"},
      {"# oST version 5.0 parameters\n\n[image]\n", "the calibrator writes ost.yaml beside ost.txt"},
      {"image_width: 640\ncamera_matrix:\n\trows: 3\n", "lines begin with tabs"},
  };
  for (const auto& [text, kind] : rows)
    EXPECT_THAT(refusal_of(text), AllOf(HasSubstr(path), HasSubstr(kind), HasSubstr("expected")));
  std::string transposed = with_focal("600", "600");
  const std::string usual = "600, 0, 320, 0, 600, 240, 0, 0, 1";
  transposed.replace(transposed.find(usual), usual.size(), "600, 0, 0, 0, 600, 0, 320, 240, 1");
  EXPECT_THAT(refusal_of(transposed), HasSubstr("rows and columns are exchanged, as MATLAB writes it"));
}

/// Ten times ten times ten times …, and one that is in itself.
TEST_F(UnusualCameraFile, OfAliasesIsBounded) {
  std::string lists = "a: &a [1,1,1,1,1,1,1,1,1,1]\n", maps = "a: &a {x: 1}\n";
  for (char name = 'b'; name < 'k'; ++name) {
    const std::string alias = std::string("*") + static_cast<char>(name - 1);
    std::string list, map;
    for (int i = 0; i < 10; ++i) {
      list += (i == 0 ? "" : ",") + alias;
      map += (i == 0 ? "k" : ", k") + std::to_string(i) + ": " + alias;
    }
    const std::string begin = std::string(1, name) + ": &" + name;
    lists += begin + " [" + list + "]\n";
    maps += begin + " {" + map + "}\n";
  }
  const std::string size = "image_width: 640\nimage_height: 480\n";
  for (const std::string& text : {lists + size + "camera_matrix: {data: *j}\n", maps + size,
                                  "a: &a {b: *a}\n" + size, size + "camera_matrix: &m [*m]\n"})
    EXPECT_THAT(refusal_of(text), HasSubstr("more than 10000 values, by aliases"));
}

TEST_F(UnusualCameraFile, ThatIsAnotherKindOfFileIsNamed) {
  using namespace std::string_literals;
  const std::vector<std::pair<std::string, std::string>> rows{
      {"\x89PNG\r\n\x1a\n\0\0\0\rIHDR"s, "a PNG picture"},
      {"\xff\xd8\xff\xe0\0\x10JFIF"s, "a JPEG picture"},
      {"RIFF\x10\0\0\0WEBPVP8 "s, "a WebP picture"},
      {"\0\0\0\x18"s + "ftypheic" + std::string(20, '\0'), "a HEIC picture"},
      {"%PDF-1.5\n", "a PDF picture"},
      {"\x1a\x45\xdf\xa3" + std::string(20, '\0'), "a Matroska or WebM video"},
      {"heel-template 1 300 2000\n{}", "a template of a shirt"},
      {"<!DOCTYPE html><html>", "a web page"},
      {"PK\x03\x04 and more", "a compressed archive"},
      {"", "an empty file"},
  };
  for (const auto& [bytes, kind] : rows)
    EXPECT_THAT(refusal_of(bytes),
                AllOf(HasSubstr(path + ": " + kind), HasSubstr("(expected a camera file")));
  // A photograph, which is larger than any camera file.
  EXPECT_THAT(refusal_of("\xff\xd8\xff\xe1" + std::string(2 << 20, 'x')), HasSubstr("a JPEG picture"));
}

}  // namespace
}  // namespace heel
