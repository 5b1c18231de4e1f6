// heel experiment family: each robot that heel knows, against the simulated one's truth.
#pragma once

#include <cstdint>
#include <string>

namespace heel::cli {

/// Writes family.csv in `folder` and prints the table. `config_file`: empty for every key at its default.
void measure_family(const std::string& folder, const std::string& config_file, std::uint64_t seed);

}  // namespace heel::cli
