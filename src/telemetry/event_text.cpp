#include "telemetry/event_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace heel {

namespace {

std::string_view text_of(const Event& event) {
  const auto* end = std::find(event.text.begin(), event.text.end(), '\0');
  return {event.text.data(), static_cast<std::size_t>(end - event.text.begin())};
}

/// The text with `number` in place of "{}".
std::string with_number(std::string_view text, std::int64_t number) {
  const std::size_t place = text.find("{}");
  if (place == std::string_view::npos) return std::string(text);
  return fmt::format("{}{}{}", text.substr(0, place), number, text.substr(place + 2));
}

}  // namespace

std::string event_text(const Event& event) {
  const char* name = to_string(event.kind);
  const std::string_view text = text_of(event);
  switch (event.kind) {
    case EventKind::FrameRefused:
      return fmt::format("{}: {}x{} px is not the size in the calibration file; check camera.info", name,
                         event.a, event.b);
    case EventKind::FrameCorrupt:
      return fmt::format("{}: {} ({} so far)", name, text, event.a);
    case EventKind::Overrun:
      return fmt::format("{}: {:.3f} ms late, {} periods missed so far", name,
                         static_cast<double>(event.b) * 1e-6, event.a);
    case EventKind::Note:
    case EventKind::Warning:
      return with_number(text, event.a);
    case EventKind::CameraOpened:
    case EventKind::CameraUnavailable:
    case EventKind::CameraLost:
    case EventKind::CameraEnded:
      break;
  }
  return fmt::format("{}: {}", name, text);
}

spdlog::level::level_enum event_level(EventKind kind) {
  switch (kind) {
    case EventKind::CameraOpened:
    case EventKind::CameraEnded:
    case EventKind::Note:
      return spdlog::level::info;
    case EventKind::FrameRefused:
      return spdlog::level::err;
    case EventKind::CameraUnavailable:
    case EventKind::CameraLost:
    case EventKind::FrameCorrupt:
    case EventKind::Overrun:
    case EventKind::Warning:
      break;
  }
  return spdlog::level::warn;
}

const char* event_part(EventKind kind) {
  switch (kind) {
    case EventKind::Overrun:
      return "schedule";
    case EventKind::Note:
    case EventKind::Warning:
      return "robot";  // all notes and warnings come from its session
    case EventKind::CameraOpened:
    case EventKind::CameraUnavailable:
    case EventKind::CameraLost:
    case EventKind::CameraEnded:
    case EventKind::FrameRefused:
    case EventKind::FrameCorrupt:
      break;
  }
  return "camera";
}

bool event_repeats(EventKind kind) {
  return kind == EventKind::FrameCorrupt || kind == EventKind::Overrun;
}

}  // namespace heel
