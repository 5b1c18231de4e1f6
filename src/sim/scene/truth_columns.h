// Columns of the world's truth in CSV files, shared by runs in real time and in lock step.
#pragma once

#include <span>

#include "sim/scene/world.h"

namespace heel::sim {

struct TruthColumn {
  const char* name;
  int decimals;
  double (*value)(const Truth& truth);
};

/// person_*, back_* and camera_*: world frame; target_*: as a perfect vision stage would report them.
std::span<const TruthColumn> world_truth_columns();

}  // namespace heel::sim
