#include "evaluation/reports/latency_figures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string_view>

#include "heel/error.h"
#include "heel/flow.h"
#include "recording/recording_reader.h"

namespace heel::evaluation {
namespace {

constexpr std::size_t kStamps = 6;
constexpr std::array<const char*, kStamps - 1> kHops{"capture to dequeued", "dequeued to vision", "vision",
                                                     "vision to tick", "tick to last byte"};

/// capture, dequeued, vision's start, vision's end, tick, last byte; 0: not known.
using Stamps = std::array<TimeNs, kStamps>;

class StampCollector final : public RecordingVisitor {
 public:
  void on_timing(const FrameTiming& timing) override {
    ++frames;
    stamps_[timing.t_capture_ns] = {timing.t_capture_ns, timing.t_dequeued_ns, timing.t_vision_ns,
                                    timing.t_done_ns};
  }
  void on_tick(const TickRecord& tick) override {
    if (t_tick_ns_ != 0) periods_ms.push_back(1e-6 * static_cast<double>(tick.input.now_ns - t_tick_ns_));
    t_tick_ns_ = tick.input.now_ns;
    if (!tick.input.has_pose || tick.input.pose.t_capture_ns == t_used_ns_) return;
    t_used_ns_ = tick.input.pose.t_capture_ns;
    ticks_[tick.input.now_ns] = t_used_ns_;
  }
  void on_wire(const WireBytes& bytes) override {
    if (bytes.to_robot) written_.push_back(bytes.t_ns);
  }
  bool wants(std::string_view topic) const override {
    return topic == "/heel/timing" || topic == "/heel/tick" || topic == "/heel/wire";
  }

  /// Of every frame that a tick has used; in the order of the ticks.
  std::vector<Stamps> commands() {
    std::sort(written_.begin(), written_.end());
    std::vector<Stamps> found;
    for (auto tick = ticks_.begin(); tick != ticks_.end(); ++tick) {
      const auto stamps = stamps_.find(tick->second);
      if (stamps == stamps_.end()) continue;
      Stamps all = stamps->second;
      all[4] = tick->first;
      // A tick writes its command at once; what is written later is that of another tick.
      const auto byte = std::lower_bound(written_.begin(), written_.end(), tick->first);
      if (byte == written_.end() || *byte - tick->first > kLongestTick_ns) continue;
      all[5] = *byte;
      found.push_back(all);
    }
    return found;
  }

  std::size_t frames = 0;
  std::vector<double> periods_ms;

 private:
  static constexpr TimeNs kLongestTick_ns = 10 * kNsPerMs;

  // By the time of capture: a camera that is opened again may count its frames from 0 again.
  std::map<TimeNs, Stamps> stamps_;
  std::map<TimeNs, TimeNs> ticks_;  // first tick with a frame, and the time of its capture
  std::vector<TimeNs> written_;
  TimeNs t_tick_ns_ = 0;
  TimeNs t_used_ns_ = 0;
};

/// Of sorted values: the smallest that so great a share of them does not exceed.
double quantile(const std::vector<double>& sorted, double share) {
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(sorted.size())));
  return sorted.empty() ? 0.0 : sorted[std::min(sorted.size(), std::max<std::size_t>(rank, 1)) - 1];
}

LatencyHop hop(const char* name, const std::vector<Stamps>& commands, std::size_t from, std::size_t to) {
  std::vector<double> times_ms;
  for (const Stamps& stamps : commands)
    if (stamps[from] != 0 && stamps[to] != 0)
      times_ms.push_back(1e-6 * static_cast<double>(stamps[to] - stamps[from]));
  std::sort(times_ms.begin(), times_ms.end());
  return {name, times_ms.size(), quantile(times_ms, 0.5), quantile(times_ms, 0.99), quantile(times_ms, 1.0)};
}

}  // namespace

LatencyFigures latency_of(const std::string& recording) {
  StampCollector collector;
  LatencyFigures figures;
  figures.file = recording_in(recording);
  read_recording(figures.file, collector);
  figures.frames = collector.frames;
  if (figures.frames == 0)
    throw Error(figures.file +
                ": no stamps of frames (expected a recording of heeld since it writes /heel/timing)");
  const std::vector<Stamps> commands = collector.commands();
  figures.commands = commands.size();
  std::sort(collector.periods_ms.begin(), collector.periods_ms.end());
  figures.period_ms = quantile(collector.periods_ms, 0.5);
  for (std::size_t i = 0; i + 1 < kStamps; ++i) figures.hops.push_back(hop(kHops[i], commands, i, i + 1));
  figures.total = hop("capture to last byte", commands, 0, kStamps - 1);
  figures.dequeued_to_last = hop("dequeued to last byte", commands, 1, kStamps - 1);
  const auto slowest =
      std::max_element(commands.begin(), commands.end(),
                       [](const Stamps& a, const Stamps& b) { return a[5] - a[0] < b[5] - b[0]; });
  if (slowest != commands.end())
    for (const TimeNs stamp : *slowest)
      figures.slowest_ms.push_back(1e-6 * static_cast<double>(stamp - (*slowest)[0]));
  return figures;
}

}  // namespace heel::evaluation
