// Live data on their way from the telemetry thread to the page's thread. Nothing is copied while nobody
// looks; the telemetry thread waits for nothing but a copy of the other thread's.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "operator/web/lateness_counts.h"
#include "telemetry/telemetry_listener.h"

namespace heel {

/// A frame that owns its pixels, without gaps.
struct KeptFrame {
  FrameHeader header;
  std::vector<std::uint8_t> grey;
};

struct PoseNews {
  PoseEstimate pose;
  std::optional<TimeNs> to_command_ns;  ///< from its exposure to the tick that used it; empty: not known
  PoseMarks marks;                      ///< of another frame: not known
};

/// What has come since the last time.
struct LiveNews {
  std::optional<TickRecord> tick;  ///< the newest
  std::vector<PoseNews> poses;
  std::optional<KeptFrame> picture;  ///< the newest
};

class LiveFeed final : public TelemetryListener {
 public:
  static constexpr std::size_t kMaxPoses = 64;

  /// `picture_hz`: largest rate of pictures.
  explicit LiveFeed(double picture_hz) : picture_period_ns_(ns_from_seconds(1.0 / picture_hz)) {}
  /// Before the telemetry thread runs: `tell` is called in it when there is news.
  void on_news(std::function<void()> tell) { tell_ = std::move(tell); }

  // The telemetry thread:
  void tick(const TickRecord& tick) override;
  void pose(const PoseEstimate& pose) override;
  void marks(const PoseMarks& marks) override;
  void event(const Event& event) override {
    if (event.kind == EventKind::Overrun)
      missed_periods_.store(static_cast<std::uint64_t>(event.a), std::memory_order_relaxed);
  }
  bool wants_pictures() override { return pictures_watched_.load(std::memory_order_relaxed); }
  void picture(const FrameView& frame) override;

  // The page's thread:
  void set_watched(bool records, bool pictures);
  /// A viewer can take a picture now; `wanted` false: all have one that they have not shown yet.
  void set_picture_wanted(bool wanted) { picture_wanted_.store(wanted, std::memory_order_relaxed); }
  LiveNews take();

  // From any thread:
  LatenessCounts::Values lateness() const { return lateness_.values(); }
  std::uint64_t missed_periods() const { return missed_periods_.load(std::memory_order_relaxed); }

 private:
  struct Used {
    std::uint64_t frame_sequence = 0;
    TimeNs to_command_ns = 0;
  };
  std::optional<TimeNs> to_command_ns(std::uint64_t frame_sequence) const;
  const PoseMarks& marks_of(std::uint64_t frame_sequence) const;
  void tell();

  const TimeNs picture_period_ns_;
  std::function<void()> tell_;
  std::atomic<bool> watched_{false}, pictures_watched_{false}, picture_wanted_{false};
  std::atomic<bool> told_{false};  // and not taken yet
  LatenessCounts lateness_;
  std::atomic<std::uint64_t> missed_periods_{0};

  // The telemetry thread's:
  std::array<Used, 8> used_{};
  std::size_t uses_ = 0;
  std::uint64_t newest_used_ = 0;
  std::array<PoseMarks, 16> marks_{};  // the newest, as many as the queue holds
  std::size_t marks_count_ = 0;
  TimeNs t_picture_ns_ = 0;  // exposure of the last one that was kept

  std::mutex mutex_;
  LiveNews news_;  // guarded by mutex_
};

}  // namespace heel
