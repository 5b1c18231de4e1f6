// A look through a camera, for the commands that judge what it sends.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "capture/frame_source.h"
#include "core/config.h"

namespace heel::cli {

inline constexpr TimeNs kLook_ns = 3 * kNsPerS;

/// The frames of a camera from the first one on.
class Look {
 public:
  /// Throws heel::Error when the camera cannot be opened.
  explicit Look(const CameraConfig& config);

  /// Calls `use` with each frame for `longest_ns` after the first, while it `goes_on`. Stops early when the
  /// source ends or the program is interrupted. Throws heel::Error when no frame comes, or the camera is
  /// lost.
  void take(
      const std::function<void(const FrameView&)>& use, TimeNs longest_ns = kLook_ns,
      const std::function<bool()>& goes_on = [] { return true; });

  std::size_t frames() const { return frames_; }
  int width_px() const { return width_px_; }
  int height_px() const { return height_px_; }
  double rate_hz() const;
  double damaged_share() const;
  const std::string& description() const { return source_->description(); }

 private:
  std::unique_ptr<FrameSource> source_;
  std::size_t frames_ = 0;
  int width_px_ = 0, height_px_ = 0;
  TimeNs t_first_ns_ = 0, t_last_ns_ = 0;
};

}  // namespace heel::cli
