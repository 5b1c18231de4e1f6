#include "evaluation/reports/latency_figures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string_view>
#include <utility>

#include "heel/error.h"
#include "heel/flow.h"
#include "recording/recording_reader.h"

namespace heel::evaluation {
namespace {

constexpr std::size_t kStamps = 7;
constexpr std::size_t kLastByte = 5, kWheels = 6;
constexpr std::array<const char*, kStamps - 1> kHops{
    "capture to dequeued", "dequeued to vision", "vision",
    "vision to tick",      "tick to last byte",  "last byte to wheels"};

/// capture, dequeued, vision's start, vision's end, tick, last byte, wheels; 0: not known.
using Stamps = std::array<TimeNs, kStamps>;

/// The tick that first used a frame.
struct UsingTick {
  TimeNs t_capture_ns = 0;
  double v_before_m_s = 0.0, v_m_s = 0.0;  // commanded
};

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
    const double v_before_m_s = std::exchange(v_m_s_, tick.command.v_m_s);
    if (!tick.input.has_pose || tick.input.pose.t_capture_ns == t_used_ns_) return;
    t_used_ns_ = tick.input.pose.t_capture_ns;
    ticks_[tick.input.now_ns] = {t_used_ns_, v_before_m_s, v_m_s_};
  }
  void on_wire(const WireBytes& bytes) override {
    if (bytes.to_robot) written_.push_back(bytes.t_ns);
  }
  bool wants(std::string_view topic) const override {
    return topic == "/heel/timing" || topic == "/heel/tick" || topic == "/heel/wire";
  }

  /// Of every frame that a tick has used; in the order of the ticks.
  std::vector<Stamps> commands(const WheelResponse* wheels) {
    std::sort(written_.begin(), written_.end());
    std::vector<Stamps> found;
    for (const auto& [t_tick_ns, tick] : ticks_) {
      const auto stamps = stamps_.find(tick.t_capture_ns);
      if (stamps == stamps_.end()) continue;
      Stamps all = stamps->second;
      all[4] = t_tick_ns;
      // A tick writes its command at once; what is written later is that of another tick.
      const auto byte = std::lower_bound(written_.begin(), written_.end(), t_tick_ns);
      if (byte == written_.end() || *byte - t_tick_ns > kLongestTick_ns) continue;
      all[kLastByte] = *byte;
      if (wheels != nullptr)
        all[kWheels] = wheels->half_way_ns(*byte, tick.v_before_m_s, tick.v_m_s).value_or(0);
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
  std::map<TimeNs, UsingTick> ticks_;
  std::vector<TimeNs> written_;
  TimeNs t_tick_ns_ = 0;
  TimeNs t_used_ns_ = 0;
  double v_m_s_ = 0.0;  // commanded by the last tick
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

LatencyFigures latency_of(const std::string& recording, const WheelResponse* wheels) {
  StampCollector collector;
  LatencyFigures figures;
  figures.file = recording_in(recording);
  read_recording(figures.file, collector);
  figures.frames = collector.frames;
  if (figures.frames == 0)
    throw Error(figures.file +
                ": no stamps of frames (expected a recording of heeld since it writes /heel/timing)");
  const std::vector<Stamps> commands = collector.commands(wheels);
  figures.commands = commands.size();
  std::sort(collector.periods_ms.begin(), collector.periods_ms.end());
  figures.period_ms = quantile(collector.periods_ms, 0.5);
  const std::size_t last = wheels == nullptr ? kLastByte : kWheels;
  for (std::size_t i = 0; i < last; ++i) figures.hops.push_back(hop(kHops[i], commands, i, i + 1));
  figures.total = hop("capture to last byte", commands, 0, kLastByte);
  figures.dequeued_to_last = hop("dequeued to last byte", commands, 1, kLastByte);
  if (wheels != nullptr) {
    figures.to_wheels = hop("capture to wheels", commands, 0, kWheels);
    if (figures.to_wheels->count == 0)
      throw Error(figures.file +
                  ": no command of it has moved the wheels of the truth (expected both of one run)");
  }
  // Without its last stamp (0), a way is shorter than any other.
  const auto way_ns = [last](const Stamps& stamps) { return stamps[last] - stamps[0]; };
  const auto slowest =
      std::max_element(commands.begin(), commands.end(),
                       [&](const Stamps& a, const Stamps& b) { return way_ns(a) < way_ns(b); });
  if (slowest != commands.end())
    for (std::size_t i = 0; i <= last; ++i)
      figures.slowest_ms.push_back(1e-6 * static_cast<double>((*slowest)[i] - (*slowest)[0]));
  return figures;
}

}  // namespace heel::evaluation
