// The limits that a run must meet: options of heel simulate and heel report.
#include "commands.h"

namespace heel::cli {

void add_criteria_options(CLI::App& command, evaluation::FollowCriteria& criteria) {
  command.add_option("--max-out-of-view-s", criteria.max_out_of_view_s,
                     "limit: longest time in which the shirt is not found");
  command.add_option("--max-rms-m", criteria.max_rms_m,
                     "limit: RMS distance of the robot from the person's path");
  command.add_option("--min-path-m", criteria.min_robot_path_m,
                     "limit: shortest distance that the robot must drive");
}

}  // namespace heel::cli
