// The header of a template file: everything but the pictures, as JSON.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "heel/shirt_template.h"

namespace heel {

/// `further_bytes`: of the picture of each further view in the file.
std::string template_header(const ShirtTemplate& shirt, const std::vector<std::size_t>& further_bytes);

/// Fills `shirt` but for its pictures; returns the bytes of the picture of each further view. Throws
/// heel::Error naming the file and what is wrong.
std::vector<std::size_t> parse_template_header(std::string_view text, const std::string& path,
                                               ShirtTemplate& shirt);

}  // namespace heel
