#include "vision/picture/picture_statistics.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>

namespace heel {
namespace {

constexpr int kLeast_px = 64;
constexpr int kLines = 40;        // sampled lines in each direction, of which edges are measured
constexpr int kBandColumns = 80;  // sampled columns of a band
constexpr int kDetail = 14;       // change of brightness that is no noise
constexpr int kStrongEdge = 60;   // an edge whose width can be measured
constexpr int kFewestEdges = 100;
constexpr double kSharpest = 0.1;  // share of the edges that tell the focus
constexpr int kComb = 15;          // displacement of every second row, as a change of brightness

int grey_at(const FrameView& frame, int x, int y) {
  return frame.grey[static_cast<std::size_t>(y) * frame.stride_bytes + static_cast<std::size_t>(x)];
}

/// Steepest slope of edges against their height, as a histogram.
class Slopes {
 public:
  void add(int slope, int height) {
    const auto bin = static_cast<std::size_t>(slope) * counts_.size() / static_cast<std::size_t>(height);
    ++counts_[std::min(bin, counts_.size() - 1)];
    ++total_;
  }

  /// Standard deviation of a Gaussian blur that makes the sharpest edges so steep; 0: too few edges.
  double blur_px() const {
    if (total_ < kFewestEdges) return 0.0;
    int steeper = 0;
    std::size_t bin = counts_.size();
    while (bin > 0 && steeper < kSharpest * total_) steeper += counts_[--bin];
    const double slope = (static_cast<double>(bin) + 0.5) / static_cast<double>(counts_.size());
    constexpr double kPeakOfGauss = 0.3989;
    return kPeakOfGauss / slope;
  }

 private:
  std::array<int, 200> counts_{};  // slope / height from 0 to 1 in steps of 0.005
  int total_ = 0;
};

/// What lines of pixels in one direction show.
struct LineSample {
  int places = 0, with_detail = 0;
  Slopes slopes;

  double detail_share() const { return places == 0 ? 0.0 : static_cast<double>(with_detail) / places; }
};

/// `grey(i)`: the pixel at place i of a line of `length` pixels; `reach`: to each side of an edge.
template <typename Grey>
void sample_line(const Grey& grey, int length, int reach, LineSample& sample) {
  const auto mean3 = [&](int i) { return (grey(i - 1) + grey(i) + grey(i + 1)) / 3; };
  for (int i = reach + 1; i + reach + 1 < length; i += 2) {
    const int height = std::abs(mean3(i + reach) - mean3(i - reach));
    ++sample.places;
    if (height > kDetail) ++sample.with_detail;
    if (height <= kStrongEdge) continue;
    int steepest = 0;
    for (int k = -reach / 2; k <= reach / 2; ++k)
      steepest = std::max(steepest, std::abs(grey(i + k + 1) - grey(i + k - 1)));
    sample.slopes.add(steepest, 2 * height);
  }
}

double sharper(double a, double b) {
  if (a == 0.0 || b == 0.0) return std::max(a, b);
  return std::min(a, b);
}

void measure_edges(const FrameView& frame, int width, int height, PictureEdges& out) {
  const double scale = std::max(1.0, width / 640.0);
  const int reach = static_cast<int>(std::lround(6.0 * scale));
  LineSample across, down;
  for (int line = 0; line < kLines; ++line) {
    const int y = (2 * line + 1) * height / (2 * kLines), x = (2 * line + 1) * width / (2 * kLines);
    sample_line([&](int i) { return grey_at(frame, i, y); }, width, reach, across);
    sample_line([&](int i) { return grey_at(frame, x, i); }, height, reach, down);
  }
  out.detail = std::max(across.detail_share(), down.detail_share());
  out.edge_blur_px = sharper(across.slopes.blur_px(), down.slopes.blur_px()) / scale;
}

/// Mean of each band's halves, and the distribution of the brightness.
void measure_brightness(const FrameView& frame, int width, int height, PictureBrightness& out) {
  std::array<int, 256> counts{};
  int total = 0;
  for (std::size_t band = 0; band < PictureBrightness::kBands; ++band) {
    const int first = static_cast<int>(band) * height / static_cast<int>(PictureBrightness::kBands);
    const int end = std::max(
        first + 1, static_cast<int>(band + 1) * height / static_cast<int>(PictureBrightness::kBands));
    std::array<int, 2> sums{}, numbers{};
    for (int y = first; y < end; y += std::max(1, (end - first) / 2)) {
      for (int column = 0; column < kBandColumns; ++column) {
        const int grey = grey_at(frame, (2 * column + 1) * width / (2 * kBandColumns), y);
        const std::size_t half = column < kBandColumns / 2 ? 0 : 1;
        sums[half] += grey;
        ++numbers[half];
        ++counts[static_cast<std::size_t>(grey)];
        ++total;
      }
    }
    for (std::size_t half = 0; half < 2; ++half)
      out.bands[half][band] = static_cast<float>(sums[half]) / static_cast<float>(numbers[half]);
  }
  const auto quantile = [&](double share) {
    int below = 0;
    std::size_t grey = 0;
    while (grey < counts.size() - 1 && below + counts[grey] < share * total) below += counts[grey++];
    return static_cast<double>(grey);
  };
  out.darkest = quantile(0.02);
  double sum = 0.0;
  for (std::size_t grey = 0; grey < counts.size(); ++grey) sum += static_cast<double>(grey) * counts[grey];
  out.mean = sum / total;
}

/// Two fields of different times show a moving upright edge at two places: rows alternate there. A pattern of
/// thin lines across alternates as well, but has no upright edges.
void measure_comb(const FrameView& frame, int width, int height, PictureEdges& out) {
  int edges = 0, combed = 0;
  for (int y = 1; y + 2 < height; y += 8) {
    for (int x = 2; x + 2 < width; x += 4) {
      const int across = std::abs(grey_at(frame, x + 2, y) - grey_at(frame, x - 2, y));
      if (across < 2 * kComb) continue;
      ++edges;
      const int a = grey_at(frame, x, y - 1), b = grey_at(frame, x, y), c = grey_at(frame, x, y + 1),
                d = grey_at(frame, x, y + 2);
      if ((a - b) * (c - b) > kComb * kComb && (b - c) * (d - c) > kComb * kComb) ++combed;
    }
  }
  out.comb = edges < kFewestEdges ? 0.0 : static_cast<double>(combed) / edges;
}

struct Size {
  int width, height;
  bool large_enough() const { return width >= kLeast_px && height >= kLeast_px; }
};

Size size_of(const FrameView& frame) {
  return {static_cast<int>(frame.header.width_px), static_cast<int>(frame.header.height_px)};
}

}  // namespace

PictureBrightness picture_brightness(const FrameView& frame) {
  PictureBrightness out;
  const Size size = size_of(frame);
  if (size.large_enough()) measure_brightness(frame, size.width, size.height, out);
  return out;
}

PictureEdges picture_edges(const FrameView& frame) {
  PictureEdges out;
  const Size size = size_of(frame);
  if (!size.large_enough()) return out;
  measure_edges(frame, size.width, size.height, out);
  measure_comb(frame, size.width, size.height, out);
  return out;
}

}  // namespace heel
