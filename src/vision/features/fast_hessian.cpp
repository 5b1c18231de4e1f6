#include "vision/features/fast_hessian.h"

#include <algorithm>
#include <optional>

#include "vision/features/scale_space_fit.h"

namespace heel {
namespace {

constexpr int kRingRows = 3;
// Nine responses of a layer round one sample cost as much as this many responses of a row.
constexpr int kSamplesPerPatch = 24;

// Samples [first, last) of a row or column.
struct SampleRange {
  int first = 0;
  int last = 0;
  bool contains(int i) const { return i >= first && i < last; }
  bool empty() const { return last <= first; }
};

SampleRange intersection(SampleRange a, SampleRange b) {
  return {std::max(a.first, b.first), std::min(a.last, b.last)};
}

SampleRange hull(SampleRange a, SampleRange b) {
  if (a.empty()) return b;
  return {std::min(a.first, b.first), std::max(a.last, b.last)};
}

SampleRange widened(SampleRange range) {
  return {range.first - 1, range.last + 1};
}

int ceil_div(int a, int b) {
  return (a + b - 1) / b;
}

// Samples at which a filter that extends `half_px` to each side fits into an image of `size_px` pixels.
SampleRange fitting(int size_px, int half_px, int step) {
  if (size_px <= 2 * half_px) return {};
  return {ceil_div(half_px, step), (size_px - 1 - half_px) / step + 1};
}

// Samples whose refined position, at most one sample away, can lie in [begin, begin + size).
SampleRange around(int begin_px, int size_px, int step) {
  return {std::max(0, begin_px / step - 1), ceil_div(begin_px + size_px, step) + 2};
}

// Half-way between a layer and the next coarser one.
float middle_sigma(int octave, int layer) {
  const int sides = octave_filter(octave, layer).side() + octave_filter(octave, layer + 1).side();
  return 0.5f * BoxFilter::kSigmaPerSide * static_cast<float>(sides);
}

bool inside(const Region& region, const Feature& keypoint) {
  // A pixel covers half a pixel to each side of its centre.
  const float x = keypoint.x_px + 0.5f - static_cast<float>(region.x_px);
  const float y = keypoint.y_px + 0.5f - static_cast<float>(region.y_px);
  return x >= 0.f && y >= 0.f && x < static_cast<float>(region.width_px) &&
         y < static_cast<float>(region.height_px);
}

}  // namespace

struct FastHessian::Octave {
  int index = 0;
  int step = 1;
  Region region;
  float sigma_min_px = 0.f, sigma_max_px = 0.f;  // of the keypoints that this octave reports
  // Where maxima are searched in each layer, and where its responses may be needed for that; empty: nowhere.
  std::array<SampleRange, kLayersPerOctave> search_rows{}, search_cols{};
  std::array<SampleRange, kLayersPerOctave> rows{}, cols{};
  SampleRange all_rows;

  bool searched(int layer) const { return !search_rows[static_cast<std::size_t>(layer)].empty(); }
};

FastHessian::FastHessian(int max_width_px)
    : ring_stride_(static_cast<std::size_t>(max_width_px + kResponsePadding + 1)),
      ring_(kLayersPerOctave * kRingRows * ring_stride_ + kResponsePadding),
      maxima_(static_cast<std::size_t>(max_width_px + kResponsePadding)),
      work_(max_width_px) {}

float* FastHessian::ring_row(int layer, int row) {
  return ring_.data() + static_cast<std::size_t>(layer * kRingRows + row % kRingRows) * ring_stride_;
}

void FastHessian::detect(const IntegralImage& integral, const Region& region, const FeatureSettings& settings,
                         KeypointSelection& selection) {
  for (int o = 0; o < std::min(settings.octaves, kMaxOctaves); ++o)
    detect_octave(integral, plan_octave(integral, region, settings, o), selection);
}

FastHessian::Octave FastHessian::plan_octave(const IntegralImage& integral, const Region& region,
                                             const FeatureSettings& settings, int index) {
  Octave octave;
  octave.index = index;
  octave.step = 1 << index;
  octave.region = region;
  // Octaves overlap in scale; where they do, the finer one reports the keypoint.
  octave.sigma_min_px = std::max(settings.sigma_min_px, index == 0 ? 0.f : middle_sigma(index - 1, 2));
  octave.sigma_max_px = settings.sigma_max_px;
  for (int m = 1; m + 1 < kLayersPerOctave; ++m) {
    if (middle_sigma(index, m) < octave.sigma_min_px || middle_sigma(index, m - 1) > octave.sigma_max_px)
      continue;
    const int half_px = octave_filter(index, m + 1).half();
    const auto search_range = [&](int size_px, int begin_px, int extent_px) {
      const SampleRange fit = fitting(size_px, half_px, octave.step);
      return intersection({fit.first + 1, fit.last - 1}, around(begin_px, extent_px, octave.step));
    };
    const auto layer = static_cast<std::size_t>(m);
    const SampleRange rows = search_range(integral.height_px(), region.y_px, region.height_px);
    const SampleRange cols = search_range(integral.width_px(), region.x_px, region.width_px);
    if (rows.empty() || cols.empty()) continue;
    octave.search_rows[layer] = rows;
    octave.search_cols[layer] = cols;
    for (std::size_t near = layer - 1; near <= layer + 1; ++near) {
      octave.rows[near] = hull(octave.rows[near], widened(rows));
      octave.cols[near] = hull(octave.cols[near], widened(cols));
    }
    octave.all_rows = hull(octave.all_rows, widened(rows));
  }
  return octave;
}

void FastHessian::detect_octave(const IntegralImage& integral, const Octave& octave,
                                KeypointSelection& selection) {
  for (auto& holds : ring_holds_) holds.fill(-1);
  for (int row = octave.all_rows.first; row < octave.all_rows.last; ++row) {
    for (int layer = 1; layer + 1 < kLayersPerOctave; ++layer) {
      if (octave.searched(layer) && octave.rows[static_cast<std::size_t>(layer)].contains(row))
        compute_rows(integral, octave, layer, row, row + 1);
    }
    for (int layer = 1; layer + 1 < kLayersPerOctave; ++layer) {
      if (octave.search_rows[static_cast<std::size_t>(layer)].contains(row - 1))
        find_maxima_in_row(integral, octave, layer, row - 1, selection);
    }
  }
}

void FastHessian::compute_rows(const IntegralImage& integral, const Octave& octave, int layer, int first,
                               int last) {
  const auto l = static_cast<std::size_t>(layer);
  for (int row = first; row < last; ++row) {
    int& holds = ring_holds_[l][static_cast<std::size_t>(row % kRingRows)];
    if (holds == row) continue;
    hessian_response_row(integral, octave_filter(octave.index, layer), row * octave.step, octave.step,
                         octave.cols[l].first, octave.cols[l].last, work_, ring_row(layer, row));
    holds = row;
  }
}

bool FastHessian::has_rows_around(int layer, int row) const {
  for (int r = row - 1; r <= row + 1; ++r) {
    if (ring_holds_[static_cast<std::size_t>(layer)][static_cast<std::size_t>(r % kRingRows)] != r)
      return false;
  }
  return true;
}

LayerRows FastHessian::rows_around(int layer, int row) {
  return {ring_row(layer, row - 1), ring_row(layer, row), ring_row(layer, row + 1)};
}

void FastHessian::find_maxima_in_row(const IntegralImage& integral, const Octave& octave, int layer, int row,
                                     KeypointSelection& selection) {
  const SampleRange cols = octave.search_cols[static_cast<std::size_t>(layer)];
  std::array<LayerRows, 2> others{};
  std::size_t known = 0;
  for (const int near : {layer - 1, layer + 1}) {
    if (octave.searched(near)) others[known++] = rows_around(near, row);
  }
  const int count = find_maxima_row(rows_around(layer, row), {others.data(), known}, cols.first, cols.last,
                                    selection.threshold(), maxima_.data());
  if (count * kSamplesPerPatch > cols.last - cols.first) {
    for (const int near : {layer - 1, layer + 1}) compute_rows(integral, octave, near, row - 1, row + 2);
  }
  for (int k = 0; k < count; ++k)
    refine(integral, octave, layer, row, maxima_[static_cast<std::size_t>(k)], selection);
}

/// Adds the keypoint at a sample that is a maximum among the neighbours computed so far. It is none if a
/// neighbour that is computed here is larger.
void FastHessian::refine(const IntegralImage& integral, const Octave& octave, int layer, int row, int column,
                         KeypointSelection& selection) {
  ResponseCube cube;
  const float centre = ring_row(layer, row)[column];
  for (int near = layer - 1; near <= layer + 1; ++near) {
    ResponsePatch& patch = cube[static_cast<std::size_t>(near - layer + 1)];
    if (has_rows_around(near, row)) {
      const LayerRows rows = rows_around(near, row);
      for (std::size_t j = 0; j < 3; ++j) std::copy_n(rows[j] + column - 1, 3, patch[j].data());
    } else if (!hessian_response_patch(integral, octave_filter(octave.index, near), column * octave.step,
                                       row * octave.step, octave.step, centre, patch)) {
      return;
    }
  }
  const std::optional<ScaleSpacePeak> peak = fit_scale_space_peak(cube);
  if (!peak) return;
  const auto step = static_cast<float>(octave.step);
  const BoxFilter filter = octave_filter(octave.index, layer);
  const auto side_step = static_cast<float>(octave_filter(octave.index, layer + 1).side() - filter.side());
  Feature keypoint;
  keypoint.x_px = step * (static_cast<float>(column) + peak->dx);
  keypoint.y_px = step * (static_cast<float>(row) + peak->dy);
  keypoint.sigma_px =
      BoxFilter::kSigmaPerSide * (static_cast<float>(filter.side()) + side_step * peak->dlayer);
  keypoint.response = peak->response;
  keypoint.octave = static_cast<std::uint8_t>(octave.index);
  if (keypoint.sigma_px < octave.sigma_min_px || keypoint.sigma_px > octave.sigma_max_px) return;
  if (!inside(octave.region, keypoint)) return;
  keypoint.laplacian = laplacian_sign(integral, filter, column * octave.step, row * octave.step);
  selection.add(keypoint);
}

}  // namespace heel
