// The answers to the foreign sets as Markdown tables.
#pragma once

#include <string>
#include <vector>

#include "evaluation/reports/foreign_figures.h"

namespace heel::evaluation {

/// Every figure of every group, three digits each, and those of the walk: shares, degrees, metres.
std::string foreign_score_table(const std::vector<ForeignSample>& samples);

/// heel's figures for readers, group by group.
std::string foreign_group_table(const std::vector<ForeignSample>& samples);

/// heel beside other methods on the same pictures: one row a method. `others` hold several methods.
std::string foreign_method_table(const std::vector<ForeignSample>& heel,
                                 const std::vector<ForeignSample>& others);

/// A picture of a fiducial marker on a back, and what its detector said. Degrees, metres.
struct MarkerSample {
  std::string method, same_scene_as;  ///< the latter: image of the foreign set with the same body and pose
  double distance_m = 0.0, yaw_set_deg = 0.0, yaw_back_deg = 0.0;
  bool found = false;
  double yaw_deg = 0.0;
};
std::vector<MarkerSample> read_markers(const std::string& path);

/// Markers beside heel in the same scenes, by distance and angle.
std::string marker_table(const std::vector<MarkerSample>& markers, const std::vector<ForeignSample>& heel);

/// What was found in pictures that do not show the shirt: `path` is written by write_false_detections().
std::string false_detection_table(const std::string& path);

}  // namespace heel::evaluation
