#include "operator/web/live_hub.h"

#include <algorithm>
#include <utility>

#include "core/frame_view.h"
#include "files/grey_encoder.h"
#include "operator/web/limits.h"
#include "operator/web/live_messages.h"
#include "operator/web/wall_clock.h"
#include "realtime/clock.h"

namespace heel {
namespace {

constexpr std::size_t kMaxLines = 50;  // of the log, at once

FrameView frame_of(const KeptFrame& kept) {
  return packed_frame(kept.grey.data(), static_cast<int>(kept.header.width_px),
                      static_cast<int>(kept.header.height_px));
}

bool can_take_picture(const LiveViewer* viewer) {
  return viewer->wants_pictures && !viewer->picture_on_its_way;
}

}  // namespace

bool LiveHub::add(LiveViewer& viewer) {
  if (viewers() >= kMaxViewers) return false;
  if (viewers() == 0) forget_lines();
  viewers_.push_back(&viewer);
  tell_feed();
  return true;
}

bool LiveHub::add(RecordViewer& viewer) {
  if (viewers() >= kMaxViewers) return false;
  if (viewers() == 0) forget_lines();
  record_viewers_.push_back(&viewer);
  tell_feed();
  return true;
}

/// What was logged before somebody looks is not news.
void LiveHub::forget_lines() {
  const std::vector<LoggedLine> newest = log_.after(0, 1);
  lines_sent_ = newest.empty() ? 0 : newest.front().number;
}

void LiveHub::remove(LiveViewer& viewer) {
  std::erase(viewers_, &viewer);
  tell_feed();
}

void LiveHub::remove(RecordViewer& viewer) {
  std::erase(record_viewers_, &viewer);
  tell_feed();
}

bool LiveHub::heard(LiveViewer& viewer, const std::string& text) {
  const ViewJson message = ViewJson::parse(text, nullptr, /*allow_exceptions=*/false);
  const std::string type = message.is_object() ? message.value("type", ViewJson()).dump() : "";
  if (type == "\"want\"") {
    viewer.wants_pictures = message.value("picture", ViewJson()) == true;
    viewer.picture_on_its_way = false;
  } else if (type == "\"picture_shown\"") {
    viewer.picture_on_its_way = false;
  } else {
    return false;
  }
  tell_feed();
  return true;
}

bool LiveHub::picture_awaited() const {
  return std::any_of(viewers_.begin(), viewers_.end(), can_take_picture) ||
         std::any_of(record_viewers_.begin(), record_viewers_.end(),
                     [](const RecordViewer* viewer) { return viewer->ready_for_picture(); });
}

void LiveHub::tell_feed() {
  const bool pictures = std::any_of(viewers_.begin(), viewers_.end(),
                                    [](const LiveViewer* viewer) { return viewer->wants_pictures; }) ||
                        std::any_of(record_viewers_.begin(), record_viewers_.end(),
                                    [](const RecordViewer* viewer) { return viewer->wants_pictures(); });
  feed_.set_watched(viewers() > 0, pictures);
  feed_.set_picture_wanted(picture_awaited());
}

void LiveHub::send_to_all(std::string text) {
  const auto message = std::make_shared<const LiveMessage>(LiveMessage{false, std::move(text)});
  // One that does not read leaves while it is sent to.
  for (LiveViewer* viewer : std::vector(viewers_)) viewer->send(message);
}

void LiveHub::send_news() {
  const LiveNews news = feed_.take();
  if (viewers() == 0) return;
  const TimeNs wall_minus_monotonic_ns = wall_now_ns() - monotonic_now_ns();
  if (news.tick) {
    const RobotGeometry& robot = shown_robot(news.tick->input.robot, robot_model_).geometry;
    send_to_all(tick_message(*news.tick, robot, wall_minus_monotonic_ns));
  }
  for (const PoseNews& one : news.poses)
    send_to_all(pose_message(one.pose, one.marks, one.to_command_ns, facts_));
  std::string jpeg;
  if (news.picture && picture_awaited()) jpeg = jpeg_of_grey(frame_of(*news.picture), quality_);
  if (!jpeg.empty()) send_picture(news.picture->header, jpeg);
  const std::vector<LoggedLine> lines = log_.after(lines_sent_, kMaxLines);
  if (!lines.empty()) lines_sent_ = lines.back().number;
  for (const LoggedLine& line : lines) send_to_all(event_message(line, wall_minus_monotonic_ns));
  for (RecordViewer* viewer : std::vector(record_viewers_)) viewer->see(news, jpeg, lines);
  if (!jpeg.empty()) tell_feed();
}

void LiveHub::send_picture(const FrameHeader& header, const std::string& jpeg) {
  ++pictures_;
  const auto message = std::make_shared<const LiveMessage>(
      LiveMessage{true, picture_message(header, jpeg, monotonic_now_ns())});
  for (LiveViewer* viewer : std::vector(viewers_)) {
    if (!can_take_picture(viewer)) continue;
    viewer->picture_on_its_way = true;
    viewer->send(message);
  }
}

}  // namespace heel
