// The known name that is nearest to a mistyped one.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace heel {

/// Least number of insertions, deletions, replacements and swaps of neighbours that turn a into b
/// (optimal string alignment).
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The candidate nearest to `name`, or empty when all are farther than half its length (at least 2).
std::string nearest_name(std::string_view name, const std::vector<std::string>& candidates);

}  // namespace heel
