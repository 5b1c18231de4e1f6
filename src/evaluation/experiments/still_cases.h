// The still experiments by name: which poses, in which surroundings.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "evaluation/experiments/still_scene.h"

namespace heel::evaluation {

struct StillCase {
  std::string name;
  StillSurroundings surroundings;
  StillView view;
};

struct StillExperiment {
  const char* name;
  const char* what;
  /// `repeats` of each pose, spread over as many surroundings as there are repeats, at most `kMostSeeds`.
  std::vector<StillCase> (*cases)(int repeats);
  int repeats;          ///< when not told otherwise
  bool keeps_pictures;  ///< DIR/NAME/NNN.png, one a case
};

inline constexpr int kMostSeeds = 8;

/// lateral, distance, yaw (the paper's Figures 2 … 6), hard (its Figure 1), errors (distributions, and what
/// the error model is fitted to).
const std::vector<StillExperiment>& still_experiments();

/// Looks at all cases. `keep` is handed the picture of every case, as the second of its rows has seen it; may
/// be empty. `progress` hears of every finished world; may be empty.
std::vector<StillRow> run_stills(const sim::Scenario& base, std::vector<StillCase> cases,
                                 double teach_distance_m, const VisionConfig& vision,
                                 const std::function<void(const StillRow&, std::size_t index,
                                                          const std::vector<std::uint8_t>& grey)>& keep,
                                 const std::function<void(std::size_t done, std::size_t of)>& progress);

}  // namespace heel::evaluation
