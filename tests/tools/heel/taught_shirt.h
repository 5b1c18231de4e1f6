// A printed shirt, its picture and camera in a folder, and the commands teach and pose on it.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "files/camera_info.h"
#include "tools/heel/printed_shirt.h"
#include "tools/heel/run_heel.h"

namespace heel::test {

inline const std::vector<std::string> kNoHurry = {"--reach-time", "600"};  // complete also on a busy machine

class TaughtShirt : public ::testing::Test {
 protected:
  void SetUp() override {
    write_camera_model(shirt_camera(), camera);
    reference = printed_plane();
    cv::imwrite(image, reference);
  }
  /// Measures the reach only where `more` says how long.
  Outcome teach(const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {"teach",         "--roi", kRoi, "--distance", "1.5",
                                          "--camera-info", camera,  "-o", shirt};
    arguments.insert(arguments.end(), more.begin(), more.end());
    if (std::find(more.begin(), more.end(), "--image") == more.end())
      arguments.insert(arguments.end(), {"--image", image});
    if (std::find(more.begin(), more.end(), kNoHurry[0]) == more.end())
      arguments.insert(arguments.end(), {kNoHurry[0], "0"});
    return run_heel(arguments);
  }
  Outcome pose(const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"pose", "--template", shirt, "--camera-info", camera};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_heel(arguments);
  }
  static std::vector<nlohmann::json> lines_of(const std::string& text) {
    std::vector<nlohmann::json> lines;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) lines.push_back(nlohmann::json::parse(line));
    return lines;
  }

  TemporaryFolder folder;
  std::string camera = folder.file("camera.yaml");
  std::string image = folder.file("back.png");
  std::string shirt = folder.file("shirt.heel");
  cv::Mat reference;
};

}  // namespace heel::test
