#include "robot/model_choice.h"

#include <algorithm>

#include "models/robot_models.h"

namespace heel {
namespace {

constexpr std::string_view kFamily = "Pioneer";
constexpr std::size_t kNone = static_cast<std::size_t>(-1);  // not in the table

/// Cut to fit; what is not printable, or means something in a message, becomes a question mark.
template <std::size_t Size>
void copy_name(std::string_view name, std::array<char, Size>& out) {
  out = {};
  const std::size_t length = std::min(name.size(), Size - 1);
  std::transform(name.begin(), name.begin() + length, out.begin(),
                 [](char c) { return c < ' ' || c > '~' || c == '{' || c == '}' ? '?' : c; });
}

bool is_pioneer(std::string_view robot_class) {
  return std::equal(robot_class.begin(), robot_class.end(), kFamily.begin(), kFamily.end(),
                    [](char a, char b) { return (a | 0x20) == (b | 0x20); });
}

}  // namespace

RobotKind choose_model(const arcos::RobotIdentity& identity, std::string_view configured) {
  RobotKind kind;
  copy_name(identity.robot_class.view(), kind.robot_class);
  copy_name(identity.subclass.view(), kind.subclass);
  const std::size_t wanted = configured == kAnyModel ? kNone : index_of_model(configured).value_or(kNone);
  const std::size_t named = index_of_model(identity.subclass.view()).value_or(kNone);
  const bool says_nothing = identity.subclass.view().empty() && identity.robot_class.view().empty();
  const std::size_t model = says_nothing ? wanted : named;
  if (says_nothing && wanted == kNone) {
    kind.choice = ModelChoice::Nameless;
  } else if (!says_nothing && (named == kNone || !is_pioneer(identity.robot_class.view()))) {
    kind.choice = ModelChoice::Unknown;
  } else if (wanted != kNone && wanted != model) {
    kind.choice = ModelChoice::Conflict;
    kind.model = static_cast<std::uint8_t>(wanted);
  } else {
    kind.choice = ModelChoice::Chosen;
    kind.model = static_cast<std::uint8_t>(model);
  }
  return kind;
}

}  // namespace heel
