// heeld with heel-sim, and a camera that shows the person in real time.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "loopback/daemon/heeld_fixture.h"
#include "loopback/daemon/live_camera.h"

namespace heel::test {

class LiveHeeld : public HeeldFixture {
 protected:
  LiveHeeld() : HeeldFixture(1) {}

  /// Later keys replace earlier ones only in another table, so the scene's source is replaced in the text.
  std::string live_config(bool realtime, const std::string& runtime = "", const std::string& sections = "") {
    const std::string path = scene_.write_config({.sections = sections, .runtime = runtime});
    std::string text = read_text(path);
    const auto replace = [&](const std::string& from, const std::string& to) {
      const std::size_t at = text.find(from);
      ASSERT_NE(at, std::string::npos) << from;
      text.replace(at, from.size(), to);
    };
    replace("file:frames", camera_.address());
    if (realtime) replace("realtime = false", "realtime = true");
    return write_text(path, text);
  }

  void start_following(const std::string& config) {
    start_robot();
    start_heeld(config);
    ASSERT_TRUE(starts_to_drive()) << logs();
  }

  LiveCamera camera_{scene_};
};

}  // namespace heel::test
