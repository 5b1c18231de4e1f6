// What the video's tests share: the person's video, a camera file, the template taught from it, and a
// configuration. It is the shipped one but for the yaw gain, which is larger so that the commands show the
// yaw, and the time-outs of a camera with 10 frames a second.
#pragma once

#include <cstdint>
#include <string>

#include "support/temporary_folder.h"
#include "support/test_data.h"

namespace heel::test {

inline const std::string kGoldenFile = source_path("tests/golden/video/knit_back_commands.golden");
inline constexpr const char* kVideo = "person/one-by-one.mp4";  ///< of the test data
inline constexpr double kVideoRate_Hz = 10.0;
inline constexpr int kVideoFrames = 1394;
inline constexpr std::uint32_t kVideoCrc32 = 0x689d095d;

/// CRC-32 (zlib) of a file.
std::uint32_t crc32_of_file(const std::string& path);

inline constexpr double kGainYaw_1_s = 2.0;

class VideoScene {
 public:
  /// Writes camera.yaml and teaches knit.heel from the video's frame 1000. Throws std::runtime_error when
  /// that fails.
  VideoScene();

  const test::TemporaryFolder& folder() const { return folder_; }
  std::string file(const std::string& name) const { return folder_.file(name); }

  /// heel.toml for `heel simulate`, and with `camera_source` given for heeld with the robot at pty:robot.
  std::string write_config(double gain_yaw_1_s, const std::string& camera_source = "") const;
  /// The scenario whose camera is the whole video, or `camera_source`; its robot turns and rolls as its
  /// odometry believes.
  std::string write_scenario(const std::string& camera_source = "", double duration_s = 145.0,
                             double vision_latency_ms = 25.0) const;
  /// Frames first…last as pictures without loss, for the file source to read in order. Returns the folder.
  std::string cut_frames(int first, int last) const;

 private:
  std::string video_;
  test::TemporaryFolder folder_;
};

}  // namespace heel::test
