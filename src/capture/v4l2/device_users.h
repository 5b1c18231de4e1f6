// Which other programs hold a device open, as far as /proc shows it to this user.
#pragma once

#include <string>

namespace heel {

/// "cheese (process 1234)", several of them separated by commas; empty when none can be seen.
std::string programs_holding(const std::string& device_path);

}  // namespace heel
