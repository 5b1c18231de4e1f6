// The table of heeld's threads as text, for docs/real-time.md.
#pragma once

#include <string>

#include "core/config.h"

namespace heel {

/// A Markdown table.
std::string thread_table_text(const Config& config);

}  // namespace heel
