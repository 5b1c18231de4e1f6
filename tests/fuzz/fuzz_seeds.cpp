// Good files from which the fuzzers of the readers start: fuzz_seeds FOLDER makes FOLDER/fuzz_picture,
// fuzz_video, fuzz_camera_file and fuzz_template.
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "files/camera_info.h"
#include "files/template_file.h"
#include "support/made_video.h"

namespace {

namespace fs = std::filesystem;

cv::Mat seed_picture(int type) {
  cv::Mat picture(16, 32, type);
  cv::randu(picture, 0, 255);
  return picture;
}

void make_pictures(const fs::path& folder) {
  for (const int type : {CV_8UC1, CV_8UC3, CV_16UC1})
    for (const char* ending : {"png", "jpg", "bmp", "pgm", "ppm", "tif", "webp"}) {
      const bool possible = (type != CV_16UC1 || (*ending != 'j' && *ending != 'b' && *ending != 'w')) &&
                            (std::string(ending) != "pgm" || type != CV_8UC3) &&
                            (std::string(ending) != "ppm" || type == CV_8UC3);
      if (possible) cv::imwrite(folder / (std::to_string(type) + "." + ending), seed_picture(type));
    }
}

void make_videos(const fs::path& folder) {
  for (const char* name : {"seed.mp4", "seed.mkv", "seed.avi", "rgb24.nut", "rgb4.nut", "pal8.nut"}) {
    heel::test::MadeVideo video{.path = folder / name, .greys = {}, .times_s = {}, .display_abcd = {}};
    video.ticks_per_s = 20;
    const std::string format = fs::path(name).stem();
    if (format != "seed") video.raw_format = format.c_str();
    for (int i = 0; i < 4; ++i) {
      video.greys.push_back(seed_picture(CV_8UC1));
      video.times_s.push_back(0.05 * i);
    }
    heel::test::write_video(video);
  }
}

heel::CameraModel small_camera() {
  heel::CameraModel camera;
  camera.width_px = 64;
  camera.height_px = 48;
  camera.fx = camera.fy = 60.0;
  camera.cx = 32.0;
  camera.cy = 24.0;
  return camera;
}

void make_templates(const fs::path& folder) {
  heel::ShirtTemplate shirt;
  shirt.camera = small_camera();
  shirt.grey.assign(64 * 48, 128);
  shirt.roi = {8, 8, 40, 32};
  shirt.distance_m = 1.5;
  heel::write_template(shirt, folder / "small.heel");
  shirt.yaw_rad = 0.5;
  shirt.upright = true;
  heel::write_template(shirt, folder / "turned.heel");
}

void make_camera_files(const fs::path& folder) {
  heel::CameraModel camera;
  camera.width_px = 640;
  camera.height_px = 480;
  camera.fx = camera.fy = 600.0;
  camera.cx = 320.0;
  camera.cy = 240.0;
  camera.k1 = -0.1;
  for (const heel::LensModel lens :
       {heel::LensModel::PlumbBob, heel::LensModel::Rational, heel::LensModel::Fisheye}) {
    camera.lens = lens;
    camera.k4 = lens == heel::LensModel::PlumbBob ? 0.0 : 0.05;
    heel::write_camera_model(camera, folder / (std::string(heel::lens_model_name(lens)) + ".yaml"));
  }
  std::ofstream(folder / "message.yaml") << R"(height: 480
width: 640
distortion_model: plumb_bob
d: [0.01 -0.02 0 0 0]
k: [612.0, 0.0, 331.0, 0.0, 608.0, 232.0, 0.0, 0.0, 1.0]
roi: {x_offset: 0}
---
)";
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  try {
    const fs::path folder = argv[1];
    for (const char* name : {"fuzz_picture", "fuzz_video", "fuzz_camera_file", "fuzz_template"})
      fs::create_directories(folder / name);
    make_pictures(folder / "fuzz_picture");
    make_videos(folder / "fuzz_video");
    make_camera_files(folder / "fuzz_camera_file");
    make_templates(folder / "fuzz_template");
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "fuzz_seeds: %s\n", error.what());
    return 1;
  }
}
