#include "golden/video/video_scene.h"

#include <zlib.h>

#include <cstdio>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <stdexcept>

#include "files/camera_info.h"
#include "heel/camera_model.h"
#include "tools/heel/run_heel.h"

namespace heel::test {

std::uint32_t crc32_of_file(const std::string& path) {
  const std::string bytes = test::read_text(path);
  return static_cast<std::uint32_t>(
      crc32_z(crc32_z(0, nullptr, 0), reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

VideoScene::VideoScene() : video_(std::filesystem::absolute(data_path(kVideo)).string()) {
  CameraModel guess;  // this camera was not calibrated
  guess.width_px = 768;
  guess.height_px = 432;
  guess.fx = guess.fy = 700.0;
  guess.cx = 383.5;
  guess.cy = 215.5;
  write_camera_model(guess, file("camera.yaml"));
  const test::Outcome taught =
      test::run_heel({"teach", "--image", video_, "--frame", "1000", "--roi", "400,90,100,175", "--distance",
                      "3", "--camera-info", file("camera.yaml"), "-o", file("knit.heel")});
  if (taught.status != 0) throw std::runtime_error("heel teach: " + taught.err);
}

std::string VideoScene::write_config(double gain_yaw_1_s, const std::string& camera_source) const {
  std::string text = "[camera]\n";
  if (!camera_source.empty())
    text += "source = \"" + camera_source + "\"\ninfo = \"camera.yaml\"\nrate_hz = 10\n";
  text +=
      "mount_x_m = 0.15\nmount_z_m = 1.1\n"
      "[target]\nshirt = \"knit.heel\"\n"
      "[control]\ngain_yaw_1_s = " +
      std::to_string(gain_yaw_1_s) +
      "\n"
      "[supervisor]\nstart = \"at_once\"\ntarget_timeout_s = 0.5\nframe_timeout_s = 0.4\n";  // 10 frames a
                                                                                             // second
  if (!camera_source.empty())
    text +=
        "[robot]\naddress = \"pty:robot\"\nsync_retry_s = 0.2\n"
        "[telemetry]\ndirectory = \"run\"\n"
        "[operator]\nsocket = \"control.sock\"\n"
        "[runtime]\nrealtime = false\n";
  return test::write_text(file("heel.toml"), text);
}

std::string VideoScene::write_scenario(const std::string& camera_source, double duration_s,
                                       double vision_latency_ms) const {
  return test::write_text(file("video.toml"),
                          "name = \"video\"\nduration_s = " + std::to_string(duration_s) +
                              "\nvision_latency_ms = " + std::to_string(vision_latency_ms) +
                              "\n[camera]\nsource = \"" +
                              (camera_source.empty() ? "file:" + video_ : camera_source) +
                              "\"\ninfo = \"camera.yaml\"\nrate_hz = 10\n"
                              "mount_x_m = 0.15\nmount_z_m = 1.1\n"
                              "[robot]\ntrue_track_m = 0.588\nleft_scale_error = 0\n"
                              "right_scale_error = 0\n");
}

std::string VideoScene::cut_frames(int first, int last) const {
  const std::string pictures = file("frames");
  std::filesystem::create_directory(pictures);
  cv::VideoCapture video(video_, cv::CAP_FFMPEG);
  cv::Mat colour, grey;
  for (int frame = 0; frame <= last; ++frame) {
    if (!video.read(colour)) throw std::runtime_error(video_ + ": ends before frame " + std::to_string(last));
    if (frame < first) continue;
    cv::cvtColor(colour, grey, cv::COLOR_BGR2GRAY);
    cv::imwrite(pictures + "/" + std::to_string(frame) + ".png", grey, {cv::IMWRITE_PNG_COMPRESSION, 1});
  }
  return pictures;
}

}  // namespace heel::test
