// What vision is measured on: a sequence of frames, the camera that took them and the shirt looked for.
#pragma once

#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "heel/flow.h"
#include "heel/shirt_template.h"

namespace heel::evaluation {

struct BenchFrame {
  cv::Mat grey;  ///< 8-bit, continuous
  TimeNs t_capture_ns = 0;

  FrameView view(std::uint64_t sequence) const;
};

struct BenchInput {
  std::string source;  ///< for people: where the frames come from
  ShirtTemplate shirt;
  CameraModel camera;
  std::vector<BenchFrame> frames;  ///< the first is for warming up only
};

/// The simulator's camera with the same field of view at another size.
CameraModel camera_of(cv::Size size);

inline constexpr double kWorldRate_Hz = 30.0;
/// Longest sequence: the person's path ends after this many frames.
inline constexpr int kMaxWorldFrames = 600;

/// A person walks a figure of eight through a cluttered room, the camera following, `size` pixels, 30 Hz. The
/// pictures depend on nothing that is measured. Throws heel::Error when the shirt cannot be taught from such
/// pictures (too small).
BenchInput walk_in_a_room(cv::Size size, int frames);

inline const cv::Size kFarShirtSize{1920, 1080};
/// A person stands so far away that the back is about 85 pixels wide in 1920 × 1080, in a cluttered room with
/// other people; every frame from another place. The frames come so long after each other that each is
/// searched as a whole.
BenchInput far_shirt_in_a_room(int frames);

}  // namespace heel::evaluation
