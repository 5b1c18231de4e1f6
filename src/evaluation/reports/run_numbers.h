// The numbers of a run's figures as CSV files in the run's folder; tools/plots draws them. Times count from
// the run's beginning; "nan" stands where there is no value. All functions throw heel::Error.
#pragma once

#include <string>

#include "evaluation/metrics/metrics.h"

namespace heel::evaluation {

/// Writes
///   path.csv         a row of truth each: both places, and whether the person walked
///   pose_errors.csv  a frame each: the estimate beside the truth, and where the robot was
///   commands.csv     a control tick each: what the robot was told
///   frames.csv       by write_kept_frames()
void write_run_numbers(const std::string& directory, const MetricsCollector& run,
                       const FollowMetrics& metrics);

/// Writes frames.csv where the folder has camera pictures (frames/) and the template (shirt.heel): up to
/// twelve of the pictures, evenly over the run, each with the corners of the recovered quadrilateral.
void write_kept_frames(const std::string& directory, double t_begin_s);

}  // namespace heel::evaluation
