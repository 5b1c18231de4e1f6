// The supervisor's tables as text for people: the middle part of docs/safety.md.
#pragma once

#include <string>

namespace heel {

/// States, what leads from each to which other, and conditions, as Markdown tables.
std::string state_manual_text();

}  // namespace heel
