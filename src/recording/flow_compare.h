// Where two flow structs differ, made from the table of their fields.
#pragma once

#include <string>
#include <vector>

#include "heel/flow.h"

namespace heel {

struct FieldDifference {
  std::string name;       ///< "target.x_m"
  std::string a, b;       ///< their texts
  double distance = 0.0;  ///< of numbers: |a - b|; NaN where it says nothing
};

/// To the bit; a NaN is like any other NaN. For TickRecord and PoseEstimate.
template <typename Flow>
bool same_flow(const Flow& a, const Flow& b);
template <typename Flow>
std::vector<FieldDifference> flow_differences(const Flow& a, const Flow& b);

}  // namespace heel
