// A message of a recording without private names.
#pragma once

#include <string>
#include <string_view>

#include "recording/redaction.h"

namespace heel {

/// Only in the members of the topic's message that hold texts of people, paths and addresses; the names of
/// members and of enumerators stay. A topic without such members stays as it is.
std::string redacted_message(const Redaction& redaction, std::string_view topic, std::string_view json);

}  // namespace heel
