#include "operator/web/live_hub.h"

#include <algorithm>
#include <utility>

#include "operator/web/limits.h"
#include "operator/web/live_messages.h"
#include "operator/web/wall_clock.h"
#include "realtime/clock.h"

namespace heel {
namespace {

constexpr std::size_t kMaxLines = 50;  // of the log, at once

}  // namespace

bool LiveHub::add(LiveViewer& viewer) {
  if (viewers_.size() >= kMaxViewers) return false;
  if (viewers_.empty()) {  // what was logged before is not news
    const std::vector<LoggedLine> newest = log_.after(0, 1);
    lines_sent_ = newest.empty() ? 0 : newest.front().number;
  }
  viewers_.push_back(&viewer);
  tell_feed();
  return true;
}

void LiveHub::remove(LiveViewer& viewer) {
  std::erase(viewers_, &viewer);
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

void LiveHub::tell_feed() {
  const auto wants = [](const LiveViewer* viewer) { return viewer->wants_pictures; };
  const auto ready = [](const LiveViewer* viewer) {
    return viewer->wants_pictures && !viewer->picture_on_its_way;
  };
  feed_.set_watched(!viewers_.empty(), std::any_of(viewers_.begin(), viewers_.end(), wants));
  feed_.set_picture_wanted(std::any_of(viewers_.begin(), viewers_.end(), ready));
}

void LiveHub::send_to_all(std::string text) {
  const auto message = std::make_shared<const LiveMessage>(LiveMessage{false, std::move(text)});
  // One that does not read leaves while it is sent to.
  for (LiveViewer* viewer : std::vector(viewers_)) viewer->send(message);
}

void LiveHub::send_news() {
  const LiveNews news = feed_.take();
  if (viewers_.empty()) return;
  const TimeNs wall_minus_monotonic_ns = wall_now_ns() - monotonic_now_ns();
  if (news.tick) {
    const RobotGeometry& robot = shown_robot(news.tick->input.robot, robot_model_).geometry;
    send_to_all(tick_message(*news.tick, robot, wall_minus_monotonic_ns));
  }
  for (const PoseNews& one : news.poses) send_to_all(pose_message(one.pose, one.to_command_ns, facts_));
  if (news.picture) send_picture(*news.picture);
  for (const LoggedLine& line : log_.after(lines_sent_, kMaxLines)) {
    lines_sent_ = line.number;
    send_to_all(event_message(line, wall_minus_monotonic_ns));
  }
}

void LiveHub::send_picture(const KeptFrame& frame) {
  const auto ready = [](const LiveViewer* viewer) {
    return viewer->wants_pictures && !viewer->picture_on_its_way;
  };
  if (std::none_of(viewers_.begin(), viewers_.end(), ready)) return;
  const std::string jpeg = jpeg_of(frame, quality_);
  if (jpeg.empty()) return;
  ++pictures_;
  const auto message = std::make_shared<const LiveMessage>(
      LiveMessage{true, picture_message(frame.header, jpeg, monotonic_now_ns())});
  for (LiveViewer* viewer : std::vector(viewers_)) {
    if (!ready(viewer)) continue;
    viewer->picture_on_its_way = true;
    viewer->send(message);
  }
  tell_feed();
}

}  // namespace heel
