// What it means where the page is served: for heeld --check and the log.
#pragma once

#include <string>

#include "core/config.h"

namespace heel {

/// One line: who can reach the page, and what they can do; empty: nothing is served. Reads the token: throws
/// heel::Error as Token::read does.
std::string page_exposure(const ViewConfig& config);

}  // namespace heel
