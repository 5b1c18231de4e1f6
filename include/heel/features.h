// Features: SURF-64 over a bounded scale range (H. Bay et al., "Speeded-Up Robust Features", CVIU 2008).
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "heel/flow.h"
#include "heel/stage_times.h"

namespace heel {

inline constexpr int kDescriptorSize = 64;

struct Feature {
  float x_px = 0.f;  ///< centre; (0,0) is the centre of the top-left pixel
  float y_px = 0.f;
  float sigma_px = 0.f;       ///< scale: a box filter of side 9 has sigma 1.2
  float angle_rad = 0.f;      ///< 0 when upright; from +x towards +y
  float response = 0.f;       ///< determinant of the scale-normalised Hessian, grey levels 0…1
  std::int8_t laplacian = 0;  ///< sign of the trace: +1 dark blob on light, −1 light blob on dark
  std::uint8_t octave = 0;    ///< that found it, from 0
};

using Descriptor = std::array<float, kDescriptorSize>;  ///< unit length

struct FeatureSettings {
  int octaves = 2;          ///< 1…4; filters of side 9…27, 15…51, 27…99, 51…195
  int max_features = 1000;  ///< at most this many are described
  float threshold = 1e-4f;  ///< smallest response kept; a blob of contrast c (0…1) has about 0.1 c²
  bool oriented = false;    ///< rotate descriptors to the dominant orientation
  bool spread = true;       ///< share max_features among the cells of a grid; false: the strongest only
  /// Look in the picture drawn twice as large: features of half the size, in four times the time. For regions
  /// of at most half the image's width and height; larger ones are looked at as they are.
  bool upsample = false;
  float sigma_min_px = 0.f;  ///< features outside [sigma_min, sigma_max] are not looked for
  float sigma_max_px = 1e9f;
};

/// A rectangle of pixels: [x, x+width) × [y, y+height).
struct Region {
  int x_px = 0, y_px = 0, width_px = 0, height_px = 0;
};

struct FeatureSet {
  std::vector<Feature> features;
  std::vector<Descriptor> descriptors;  ///< same order
};

/// Finds and describes features. Memory is taken once, for the largest image given to the constructor;
/// `extract` does not allocate when `out` has had the capacity reserved by `reserve`.
class FeatureExtractor {
 public:
  FeatureExtractor(int max_width_px, int max_height_px, const FeatureSettings& settings);
  ~FeatureExtractor();
  FeatureExtractor(FeatureExtractor&&) noexcept;
  FeatureExtractor& operator=(FeatureExtractor&&) noexcept;

  const FeatureSettings& settings() const;
  /// Takes effect at the next extract; octaves and max_features may only shrink.
  void set_settings(const FeatureSettings& settings);

  void reserve(FeatureSet& out) const;
  /// Features of `frame` inside `region` (clipped to the frame; the whole frame by default), strongest first.
  void extract(const FrameView& frame, FeatureSet& out) { extract(frame, Region{}, out); }
  void extract(const FrameView& frame, const Region& region, FeatureSet& out);

  /// From now on `times`, which must outlive this, hears of the steps; null: nobody does.
  void measure(StageTimes* times);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace heel
