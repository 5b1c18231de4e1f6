#include "experiment_family.h"

#include <fmt/format.h>

#include <cstdio>

#include "config/config_load.h"
#include "evaluation/experiments/robot_family.h"

namespace heel::cli {

void measure_family(const std::string& folder, const std::string& config_file, std::uint64_t seed) {
  const Config config = config_file.empty() ? Config{} : load_config(config_file).config;
  const auto drives = evaluation::drive_family(config, seed);
  const std::string file = folder + "/family.csv";
  evaluation::write_family(drives, file);
  fmt::print("{}{:<10} {} robots: {}\n", evaluation::family_table(drives), "family", drives.size(), file);
  std::fflush(stdout);
}

}  // namespace heel::cli
