// The subcommands of `heel`, one source file each. A command registers its options, and its work as a
// callback.
//
// How a command ends:
//   returns                     exit status 0
//   throws heel::Error          bad usage or input: one line "heel NAME: …" on stderr, exit status 2
//   throws CLI::RuntimeError(1) it worked and the answer is no (template refused, limit not met);
//                               the command has printed the reason
//   throws CLI::RuntimeError(69) heeld cannot be reached (EX_UNAVAILABLE of sysexits(3)); the same
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "evaluation/metrics/metrics.h"

namespace heel::cli {

inline constexpr int kExitNo = 1;
inline constexpr int kExitBadInput = 2;
inline constexpr int kExitUnreachable = 69;

/// Adds the options --max-out-of-view-s, --max-rms-m and --min-path-m. A run that does not meet them ends
/// with exit status 1.
void add_criteria_options(CLI::App& command, evaluation::FollowCriteria& criteria);

/// Accepts finite numbers from `least` to `most`. (CLI::Range accepts "nan".)
CLI::Validator number_from(double least, double most);
/// The same of lengths. A refusal says what a number would be in metres if it was meant as millimetres.
CLI::Validator metres_from(double least, double most);
/// Accepts whole numbers from 0. `kind` is what a refusal says was expected: "a frame number".
CLI::Validator whole_number(const std::string& kind);
/// Accepts finite numbers of seconds above 0.
CLI::Validator duration_s();

void add_calibrate_command(CLI::App& app);
void add_card_command(CLI::App& app);
void add_teach_command(CLI::App& app);
void add_pose_command(CLI::App& app);
void add_preflight_command(CLI::App& app);
void add_setup_command(CLI::App& app);
void add_features_command(CLI::App& app);
void add_simulate_command(CLI::App& app);
void add_tune_command(CLI::App& app);
void add_merge_command(CLI::App& app);
void add_report_command(CLI::App& app);
void add_experiment_command(CLI::App& app);
void add_fit_command(CLI::App& app);
void add_bench_command(CLI::App& app);
void add_bench_vision_command(CLI::App& bench);
void add_bench_control_command(CLI::App& bench);
void add_bench_daemon_command(CLI::App& bench);
void add_status_command(CLI::App& app);
void add_start_command(CLI::App& app);
void add_stop_command(CLI::App& app);
void add_estop_command(CLI::App& app);
void add_reset_command(CLI::App& app);
void add_set_command(CLI::App& app);
void add_save_command(CLI::App& app);
void add_watch_command(CLI::App& app);
void add_bundle_command(CLI::App& app);
void add_mark_command(CLI::App& app);
void add_replay_command(CLI::App& app);
void add_export_command(CLI::App& app);
void add_latency_command(CLI::App& app);

}  // namespace heel::cli
