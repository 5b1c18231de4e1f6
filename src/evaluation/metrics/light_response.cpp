#include "evaluation/metrics/light_response.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "heel/error.h"

namespace heel::evaluation {
namespace {

constexpr double kSettledShare = 0.4;  // of the time between two switches, at its end
// A tile follows the light when on and off differ by more than noise and what moves in the picture make them
// differ.
constexpr double kLeastContrast = 8.0;
constexpr double kLeastDeviations = 4.0;
constexpr std::size_t kLeastTiles = 4;  // fewer are chance: there are 768
constexpr double kShown = 0.5;          // share of the change

/// The frames between a switch and the next one: [first, last).
struct Interval {
  bool on;
  std::size_t first, settled, last;
};

std::vector<Interval> intervals_of(std::span<const LightFrame> frames,
                                   std::span<const LightSwitch> switches) {
  const auto frame_after = [&](double t_ns) {
    const auto found = std::ranges::find_if(
        frames, [&](const LightFrame& frame) { return static_cast<double>(frame.t_dequeued_ns) > t_ns; });
    return static_cast<std::size_t>(found - frames.begin());
  };
  std::vector<Interval> intervals;
  for (std::size_t i = 0; i < switches.size(); ++i) {
    const bool is_last = i + 1 == switches.size();
    const TimeNs end_ns = !is_last         ? switches[i + 1].t_ns
                          : frames.empty() ? switches[i].t_ns
                                           : frames.back().t_dequeued_ns;
    const auto begin = static_cast<double>(switches[i].t_ns), end = static_cast<double>(end_ns);
    const std::size_t last = is_last ? frames.size() : frame_after(end);
    intervals.push_back({switches[i].on, frame_after(begin),
                         std::min(last, frame_after(end - kSettledShare * (end - begin))), last});
  }
  return intervals;
}

/// Over the settled frames of each interval: mean, and variance of the intervals' means.
struct Settled {
  std::vector<TileLevels> means;  // one for each interval that has settled frames

  void add(std::span<const LightFrame> frames) {
    if (frames.empty()) return;
    TileLevels mean{};
    for (const LightFrame& frame : frames)
      for (std::size_t i = 0; i < mean.size(); ++i)
        mean[i] += frame.tiles[i] / static_cast<float>(frames.size());
    means.push_back(mean);
  }
  double mean(std::size_t tile) const {
    double sum = 0.0;
    for (const TileLevels& of : means) sum += static_cast<double>(of[tile]);
    return sum / static_cast<double>(means.size());
  }
  double variance(std::size_t tile) const {
    const double centre = mean(tile);
    double sum = 0.0;
    for (const TileLevels& of : means) sum += std::pow(static_cast<double>(of[tile]) - centre, 2);
    return sum / std::max(1.0, static_cast<double>(means.size()) - 1.0);
  }
};

struct LitTile {
  std::size_t index;
  double off, contrast;
};

std::vector<LitTile> lit_tiles(const Settled& on, const Settled& off) {
  if (on.means.empty() || off.means.empty())
    throw Error("the light: too few frames (expected several while it is on and while it is off)");
  std::vector<LitTile> lit;
  double largest = 0.0;
  for (std::size_t i = 0; i < TileLevels{}.size(); ++i) {
    const double contrast = on.mean(i) - off.mean(i);
    largest = std::max(largest, contrast);
    const double deviation = std::sqrt(on.variance(i) + off.variance(i));
    if (contrast >= kLeastContrast && contrast >= kLeastDeviations * deviation)
      lit.push_back({i, off.mean(i), contrast});
  }
  if (lit.size() < kLeastTiles)
    throw Error(fmt::format(
        "the light: no part of the picture follows it ({} of {} parts do, expected {} or more; the "
        "largest change is {:.1f} of 255, expected {:g}): point the camera at it, nearer, and "
        "darken the room",
        lit.size(), TileLevels{}.size(), kLeastTiles, largest, kLeastContrast));
  return lit;
}

/// 0: as when it is off; 1: as when it is on.
double share_shown(const LightFrame& frame, std::span<const LitTile> lit) {
  double sum = 0.0, weight = 0.0;
  for (const LitTile& tile : lit) {
    sum += tile.contrast * (static_cast<double>(frame.tiles[tile.index]) - tile.off);
    weight += tile.contrast * tile.contrast;
  }
  return sum / weight;
}

}  // namespace

TileLevels tile_levels(const FrameView& frame) {
  TileLevels levels{};
  const auto edge = [](std::size_t i, std::uint32_t size, std::size_t parts) {
    return i * static_cast<std::size_t>(size) / parts;
  };
  for (std::size_t row = 0; row < kTileRows; ++row) {
    const std::size_t y0 = edge(row, frame.header.height_px, kTileRows),
                      y1 = edge(row + 1, frame.header.height_px, kTileRows);
    for (std::size_t column = 0; column < kTileColumns; ++column) {
      const std::size_t x0 = edge(column, frame.header.width_px, kTileColumns),
                        x1 = edge(column + 1, frame.header.width_px, kTileColumns);
      std::uint64_t sum = 0;
      for (std::size_t y = y0; y < y1; ++y) {
        const std::uint8_t* grey = frame.grey + y * frame.stride_bytes;
        for (std::size_t x = x0; x < x1; ++x) sum += grey[x];
      }
      const std::size_t pixels = std::max<std::size_t>(1, (y1 - y0) * (x1 - x0));
      levels[row * kTileColumns + column] = static_cast<float>(sum) / static_cast<float>(pixels);
    }
  }
  return levels;
}

LightResponse light_response(std::span<const LightFrame> frames, std::span<const LightSwitch> switches) {
  const std::vector<Interval> intervals = intervals_of(frames, switches);
  Settled on, off;
  for (const Interval& interval : intervals)
    (interval.on ? on : off).add(frames.subspan(interval.settled, interval.last - interval.settled));
  const std::vector<LitTile> lit = lit_tiles(on, off);

  LightResponse response{.tiles = lit.size()};
  for (const LitTile& tile : lit) response.contrast += tile.contrast / static_cast<double>(lit.size());
  for (std::size_t i = 0; i < intervals.size(); ++i) {
    for (std::size_t frame = intervals[i].first; frame < intervals[i].last; ++frame) {
      const double share = share_shown(frames[frame], lit);
      if ((intervals[i].on ? share : 1.0 - share) < kShown) continue;
      response.seen.push_back({i, frame});
      break;
    }
  }
  return response;
}

}  // namespace heel::evaluation
