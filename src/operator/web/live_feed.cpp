#include "operator/web/live_feed.h"

#include <algorithm>
#include <cstring>

namespace heel {
namespace {

/// A frame may come this much before its time: cameras are not exact.
constexpr TimeNs kEarly_ns = 5 * kNsPerMs;

}  // namespace

void LiveFeed::tick(const TickRecord& tick) {
  lateness_.add(tick.input.lateness_ns);
  const PoseEstimate& pose = tick.input.pose;
  if (tick.input.has_pose && pose.frame_sequence != newest_used_) {
    newest_used_ = pose.frame_sequence;
    used_[uses_++ % used_.size()] = {pose.frame_sequence, tick.input.now_ns - pose.t_capture_ns};
  }
  if (!watched_.load(std::memory_order_relaxed)) return;
  {
    const std::lock_guard lock(mutex_);
    news_.tick = tick;
  }
  tell();
}

std::optional<TimeNs> LiveFeed::to_command_ns(std::uint64_t frame_sequence) const {
  const auto found = std::find_if(used_.begin(), used_.end(), [=](const Used& one) {
    return one.to_command_ns != 0 && one.frame_sequence == frame_sequence;
  });
  return found == used_.end() ? std::nullopt : std::optional(found->to_command_ns);
}

void LiveFeed::marks(const PoseMarks& marks) {
  if (watched_.load(std::memory_order_relaxed)) marks_[marks_count_++ % marks_.size()] = marks;
}

const PoseMarks& LiveFeed::marks_of(std::uint64_t frame_sequence) const {
  static const PoseMarks kUnknown;
  const auto found = std::find_if(marks_.begin(), marks_.end(),
                                  [=](const PoseMarks& one) { return one.frame_sequence == frame_sequence; });
  return found == marks_.end() ? kUnknown : *found;
}

void LiveFeed::pose(const PoseEstimate& pose) {
  if (!watched_.load(std::memory_order_relaxed)) return;
  {
    const std::lock_guard lock(mutex_);
    if (news_.poses.size() < kMaxPoses)
      news_.poses.push_back({pose, to_command_ns(pose.frame_sequence), marks_of(pose.frame_sequence)});
  }
  tell();
}

void LiveFeed::picture(const FrameView& frame) {
  if (!picture_wanted_.load(std::memory_order_relaxed)) return;
  const FrameHeader& header = frame.header;
  if (t_picture_ns_ != 0 && header.t_capture_ns - t_picture_ns_ < picture_period_ns_ - kEarly_ns) return;
  t_picture_ns_ = header.t_capture_ns;
  {
    const std::lock_guard lock(mutex_);
    if (!news_.picture) news_.picture.emplace();
    KeptFrame& kept = *news_.picture;
    kept.header = header;
    kept.grey.resize(std::size_t{header.width_px} * header.height_px);
    for (std::uint32_t row = 0; row < header.height_px; ++row)
      std::memcpy(kept.grey.data() + std::size_t{row} * header.width_px,
                  frame.grey + std::size_t{row} * frame.stride_bytes, header.width_px);
  }
  tell();
}

void LiveFeed::tell() {
  if (!told_.exchange(true, std::memory_order_acq_rel) && tell_) tell_();
}

void LiveFeed::set_watched(bool records, bool pictures) {
  watched_.store(records, std::memory_order_relaxed);
  pictures_watched_.store(pictures, std::memory_order_relaxed);
}

LiveNews LiveFeed::take() {
  told_.store(false, std::memory_order_release);
  LiveNews news;
  const std::lock_guard lock(mutex_);
  std::swap(news, news_);
  return news;
}

}  // namespace heel
