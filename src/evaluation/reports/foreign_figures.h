// The figures over the answers to a foreign set (foreign.csv), group by group: what is found, how far the yaw
// and the place are off, and whether the stated sigma is right.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace heel::evaluation {

/// One picture and the answer of one method. Angles in degrees, lengths in metres.
struct ForeignSample {
  std::string method, image, kind, build, print;
  double t_s = 0.0, distance_m = 0.0, yaw_set_deg = 0.0;
  double yaw_back_deg = 0.0, yaw_walk_deg = 0.0;  ///< the truth, and the direction of the path
  bool found = false;
  double certainty = 0.0;
  double yaw_deg = 0.0, yaw_sigma_deg = 0.0;  ///< of what was found; sigma NaN: none stated
  double distance_ratio = 0.0;                ///< estimated to true
  double along_m = 0.0, across_m = 0.0;       ///< error of the position along and across the line of sight

  double error_deg() const { return yaw_deg - yaw_back_deg; }
  bool is_person() const { return kind == "static" || kind == "calm" || kind == "rigid"; }
  bool is_sure() const;    ///< found with a certainty that the paper calls reliable
  bool is_wrong() const;   ///< found, and the yaw is off by more than 15°, or the distance by a tenth
  bool is_turned() const;  ///< the back is turned by 10° or more: its side can be mistaken
};

std::vector<ForeignSample> read_foreign(const std::string& path);

using ForeignSamples = std::vector<const ForeignSample*>;
using ForeignCondition = std::function<bool(const ForeignSample&)>;
ForeignSamples chosen(const std::vector<ForeignSample>& samples, const ForeignCondition& belongs);

struct ForeignFigures {
  std::size_t pictures = 0, found = 0, sure = 0;
  std::size_t wrong = 0, wrong_of_sure = 0;
  std::size_t turned = 0, flips = 0;  ///< found and turned; of these seen turned to the other side
  double yaw_mean_deg = 0.0, yaw_median_deg = 0.0, yaw_p95_deg = 0.0;  ///< of the absolute errors
  /// Mean of (error / sigma)², each at most 25: of all, and of each third by stated sigma.
  double nees = 0.0;
  std::vector<double> nees_of_thirds;
  double along_rms_m = 0.0, across_rms_m = 0.0;  ///< of those that are not wrong
  double certainty_median = 0.0;

  double share(std::size_t part) const {
    return pictures > 0 ? static_cast<double>(part) / static_cast<double>(pictures) : 0.0;
  }
};
ForeignFigures foreign_figures(const ForeignSamples& samples);

struct ForeignGroup {
  std::string name;
  ForeignFigures figures;
};
/// The groups of the set by distance, angle, kind, print and build, those that have pictures; of one method.
std::vector<ForeignGroup> foreign_groups(const std::vector<ForeignSample>& samples);

/// How the errors of a walk follow each other. RMS, in degrees.
struct WalkFigures {
  double change_deg = 0.0;            ///< of the error from frame to frame
  double direction_deg = 0.0;         ///< of the yaw against the path
  double stride_direction_deg = 0.0;  ///< of its mean over a pair of strides
};
/// Of the last walk in the samples; nothing where there is none with enough frames found.
std::optional<WalkFigures> walk_figures(const std::vector<ForeignSample>& samples);

}  // namespace heel::evaluation
