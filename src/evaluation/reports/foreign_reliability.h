// Whether what is stated can be relied on: the share of right poses over the certainty, and the error over
// the stated sigma of yaw.
#pragma once

#include <string>
#include <vector>

#include "evaluation/reports/foreign_figures.h"
#include "evaluation/reports/still_samples.h"

namespace heel::evaluation {

/// A found pose as a reliability diagram needs it.
struct StatedPose {
  double certainty = 0.0;
  double yaw_error_deg = 0.0, yaw_sigma_deg = 0.0;
  bool right = true;
};
std::vector<StatedPose> stated_poses(const ForeignSamples& samples);
std::vector<StatedPose> stated_poses(const std::vector<StillSample>& samples);

struct CertaintyBin {
  double from = 0.0, to = 0.0, mean = 0.0;
  std::size_t found = 0, right = 0;
};
/// Bins without a pose are left out.
std::vector<CertaintyBin> certainty_bins(const std::vector<StatedPose>& poses);

/// Poses of similar stated sigma, as many in each bin.
struct SigmaBin {
  std::size_t found = 0;
  double sigma_deg = 0.0;  ///< RMS of the stated ones
  double error_deg = 0.0;  ///< RMS
};
std::vector<SigmaBin> sigma_bins(std::vector<StatedPose> poses);

/// Writes DIR/foreign_certainty.csv and DIR/foreign_sigma.csv, from which the figure foreign_reliability is
/// drawn: of the foreign stills and walks, and of the own world's pictures where there are some.
void write_reliability(const std::vector<ForeignSample>& foreign, const std::vector<StillSample>& own,
                       const std::string& directory);

}  // namespace heel::evaluation
