#include "robot/session_event_text.h"

#include <algorithm>
#include <string_view>

#include "core/robot_name.h"
#include "models/robot_models.h"

namespace heel {
namespace {

/// What stands for the placeholder at the beginning of `text`, and how long that is; empty: none is there.
struct Replacement {
  std::string_view placeholder, by;
  bool is_name = false;  // of a robot, which may be empty or have a space
};

Replacement replacement_at(std::string_view text, const RobotKind& kind, std::string_view heard) {
  const auto models = robot_models();
  const std::string_view model =
      kind.model < models.size() ? models[kind.model].subclass : std::string_view();
  for (const Replacement& one : {Replacement{"{class}", kind.robot_class.data(), true},
                                 Replacement{"{subclass}", kind.subclass.data(), true},
                                 Replacement{"{model}", model}, Replacement{"{text}", heard}}) {
    if (text.starts_with(one.placeholder)) return one;
  }
  return {};
}

}  // namespace

void write_event_text(const SessionEvent& event, const RobotKind& kind, std::string_view heard,
                      std::span<char> out) {
  std::string_view text = to_string(event.kind);
  std::size_t size = 0;
  const auto put = [&](std::string_view part) {
    const std::size_t count = std::min(part.size(), out.size() - 1 - size);
    std::copy_n(part.begin(), count, out.begin() + static_cast<std::ptrdiff_t>(size));
    size += count;
  };
  while (!text.empty()) {
    const Replacement found = replacement_at(text, kind, heard);
    const std::string_view mark = found.is_name && !is_plain_name(found.by) ? "'" : "";
    put(mark);
    put(found.placeholder.empty() ? text.substr(0, 1) : found.by);
    put(mark);
    text.remove_prefix(std::max<std::size_t>(1, found.placeholder.size()));
  }
  out[size] = '\0';
}

}  // namespace heel
