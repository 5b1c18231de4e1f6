// What is wrong with the pictures of a camera, as far as they tell by themselves: a cap on the lens, a lens
// out of focus, light that flickers. It changes no pose; people are told why nothing is found.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "heel/flow.h"
#include "vision/picture/picture_statistics.h"

namespace heel {

/// True for the time `t_ns` when `raw` has been true for `on_ns`, until it has been false for half a second.
class LastingCondition {
 public:
  explicit LastingCondition(TimeNs on_ns) : on_ns_(on_ns) {}
  bool update(bool raw, TimeNs t_ns);
  void reset() { *this = LastingCondition(on_ns_); }

 private:
  TimeNs on_ns_;
  TimeNs t_change_ns_ = 0;  // since then `raw` has been as it is
  bool raw_ = false, active_ = false, any_ = false;
};

/// Bands of light that move over the picture: a lamp on the mains, seen by a rolling shutter.
class FlickerDetector {
 public:
  FlickerDetector();
  /// Whether bands as strong as 3 % differ between this picture and the one before.
  bool update(const PictureBrightness& now);
  void reset() { any_ = false; }

 private:
  using Bands = std::array<float, PictureBrightness::kBands>;
  double banded_share(const Bands& difference) const;

  std::vector<Bands> sines_;  // sine and cosine in turn, a pair for each number of bands
  std::array<Bands, 2> before_{};
  bool any_ = false;
};

/// The brightness of the whole picture that goes up and down: automatic exposure that does not settle.
class HuntingDetector {
 public:
  bool update(double mean, TimeNs t_ns);
  void reset() { *this = HuntingDetector(); }

 private:
  static constexpr std::size_t kTurns = 6;
  std::array<TimeNs, kTurns> t_turns_ns_{};  // the newest turns of the brightness, in a ring
  std::size_t turns_ = 0;
  double extreme_ = 0.0;  // logarithm of the brightness where it turned last, or since
  int direction_ = 0;
  bool any_ = false;
};

/// Brightness is looked at in each picture, since light that flickers needs two pictures in a row; edges in
/// every third. The same frames in the same order give the same faults. A gap of more than a second, or
/// another size, starts it again. Allocates nothing after construction.
class PictureMonitor {
 public:
  /// The fault of the pictures up to this one that hides most.
  PictureFault update(const FrameView& frame);

 private:
  void reset();

  FrameHeader last_;
  LastingCondition dark_{500 * kNsPerMs}, too_bright_{500 * kNsPerMs}, no_detail_{kNsPerS},
      out_of_focus_{3 * kNsPerS};
  LastingCondition flicker_{0}, interlaced_{0}, hunting_{0};
  FlickerDetector flicker_detector_;
  HuntingDetector hunting_detector_;
  PictureEdges edges_;                         // of the last picture in which they were looked at
  int pictures_to_edges_ = 0;                  // to come before they are looked at again
  std::uint32_t flickering_ = 0, combed_ = 0;  // bits: the last 32 that were looked at, the newest lowest
};

}  // namespace heel
