// An order of file names in which numbers count by value: frame9 before frame10.
#pragma once

#include <string_view>

namespace heel {

/// Runs of digits compare by value, everything else by byte. A strict weak order; names that differ only in
/// leading zeros are ordered by length.
bool natural_less(std::string_view a, std::string_view b);

}  // namespace heel
