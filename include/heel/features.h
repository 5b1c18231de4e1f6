/// \file
/// SURF-64 features of a grey image, over a bounded range of scales.
///
/// - Convention: pixel (0,0) is the centre of the top-left pixel; angles turn from +x (right) towards +y
///   (down).
/// - Units: pixels and radians; the response is that of grey levels 0…1.
/// - Errors: heel::Error for settings out of range and for frames larger than prepared for. An image without
///   features gives an empty set.
/// - Source: H. Bay, A. Ess, T. Tuytelaars, L. Van Gool, "Speeded-Up Robust Features (SURF)", CVIU 110(3),
///   2008.
///
/// The results are the same to the bit on every instruction set that Highway picks.
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

/// A blob: where it is, how large, how strong.
struct Feature {
  float x_px = 0.f;  ///< centre; (0,0) is the centre of the top-left pixel
  float y_px = 0.f;
  float sigma_px = 0.f;       ///< scale: a box filter of side 9 has sigma 1.2
  float angle_rad = 0.f;      ///< 0 when upright; from +x towards +y
  float response = 0.f;       ///< determinant of the scale-normalised Hessian, grey levels 0…1
  std::int8_t laplacian = 0;  ///< sign of the trace: +1 dark blob on light, −1 light blob on dark
  std::uint8_t octave = 0;    ///< the octave that found it, from 0
};

/// Sums of Haar wavelet responses in 4 × 4 fields round a feature, as a vector of unit length.
using Descriptor = std::array<float, kDescriptorSize>;

/// What is searched for, and how much of it is described.
struct FeatureSettings {
  int octaves = 2;          ///< 1…4; filters of side 9…27, 15…51, 27…99, 51…195
  int max_features = 1000;  ///< at most this many are described
  float threshold = 1e-4f;  ///< smallest response kept; a blob of contrast c (0…1) has about 0.1 c²
  bool oriented = false;    ///< rotate descriptors to the dominant orientation
  bool spread = true;       ///< share max_features among the cells of a grid; false: the strongest only
  /// Enlarge the region by two first: finds features of half the size, in four times the time. Only for
  /// regions of at most half the image's width and height; larger ones are searched as they are.
  bool upsample = false;
  float sigma_min_px = 0.f;  ///< features outside [sigma_min, sigma_max] are not searched for
  float sigma_max_px = 1e9f;
};

/// A rectangle of pixels: [x, x+width) × [y, y+height).
struct Region {
  int x_px = 0, y_px = 0, width_px = 0, height_px = 0;
};

/// The features of one image.
struct FeatureSet {
  std::vector<Feature> features;
  std::vector<Descriptor> descriptors;  ///< same order
};

/// Finds and describes features. Memory is taken once, for the largest image given to the constructor;
/// extract() does not allocate when reserve() was called for `out`. One thread at a time.
class FeatureExtractor {
 public:
  /// Throws heel::Error when a size is below 1 or `settings` are out of range.
  FeatureExtractor(int max_width_px, int max_height_px, const FeatureSettings& settings);
  ~FeatureExtractor();
  FeatureExtractor(FeatureExtractor&&) noexcept;
  FeatureExtractor& operator=(FeatureExtractor&&) noexcept;

  const FeatureSettings& settings() const;
  /// Takes effect at the next extract(). Values out of range are clamped; max_features may only shrink.
  void set_settings(const FeatureSettings& settings);

  /// Gives `out` room for max_features.
  void reserve(FeatureSet& out) const;
  /// Features of the whole frame, strongest first. Throws heel::Error when it is larger than prepared for.
  void extract(const FrameView& frame, FeatureSet& out) { extract(frame, Region{}, out); }
  /// Features inside `region`, which is clipped to the frame; an empty region is the whole frame.
  void extract(const FrameView& frame, const Region& region, FeatureSet& out);

  /// From now on the end of each step is reported to `times`, which must outlive this; null: no reports.
  void report_stage_times(StageTimes* times);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace heel
