// The columns of truth.csv that tell of person, camera and target; one table for real time and lock step.
#pragma once

#include <span>

#include "sim/scene/world.h"

namespace heel::sim {

struct TruthColumn {
  const char* name;
  int decimals;
  double (*value)(const Truth& truth);
};

/// person_*, back_* and camera_* in the world frame; target_* as a perfect vision stage would report it.
std::span<const TruthColumn> world_truth_columns();

}  // namespace heel::sim
