// From the rows of still experiments and of runs to what the error model is fitted to.
#pragma once

#include <vector>

#include "evaluation/metrics/metrics.h"
#include "evaluation/reports/still_samples.h"
#include "heel/camera_model.h"
#include "sim/pose_noise/error_fit.h"

namespace heel::evaluation {

/// `samples` as `heel experiment errors` writes them: two pictures of each case, one after the other.
std::vector<sim::FitRow> still_fit_rows(const std::vector<StillSample>& samples, const CameraModel& camera);

/// Every frame of a run in which the person walks and was found.
std::vector<sim::FitRow> walk_fit_rows(const MetricsCollector& run, const CameraModel& camera);

}  // namespace heel::evaluation
