// The limits that a run must meet: options of heel simulate and heel report.
#include "commands.h"

namespace heel::cli {

void add_criteria_options(CLI::App& command, evaluation::FollowCriteria& criteria) {
  command.add_option("--max-out-of-view-s", criteria.max_out_of_view_s,
                     "exit status 1 if the shirt is not found for longer");
  command.add_option("--max-rms-m", criteria.max_rms_m,
                     "exit status 1 if the RMS distance from the person's path is larger, metres");
  command.add_option("--min-path-m", criteria.min_robot_path_m,
                     "exit status 1 if the robot drives less, metres");
}

}  // namespace heel::cli
