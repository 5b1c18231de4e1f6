#include "experiment_family.h"

#include <fmt/format.h>

#include "commandline/progress.h"
#include "config/config_load.h"
#include "evaluation/experiments/robot_family.h"

namespace heel::cli {

void measure_family(const ExperimentOptions& options, ExperimentResults& results) {
  const Config config = options.config_file.empty() ? Config{} : load_config(options.config_file).config;
  commandline::Progress progress(std::string(kFamily) + ", robots");
  const auto drives = evaluation::drive_family(
      config, options.seed, [&](std::size_t done, std::size_t of) { progress.show(done, of); });
  progress.clear();
  const std::string file = options.out + "/" + kFamily + ".csv";
  evaluation::write_family(drives, file);
  results.add(kFamily, {{"file", file}, {"robots", drives.size()}},
              fmt::format("{}{:<10} {} robots: {}\n", evaluation::family_table(drives), kFamily,
                          drives.size(), file));
}

}  // namespace heel::cli
