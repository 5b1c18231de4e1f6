// What heel-sim says about itself beside its options.
#pragma once

#include "commandline/program_text.h"

namespace heel::sim {

inline constexpr int kExitInput = 1;  ///< a file, an address or a device
inline constexpr int kExitUsage = 2;

commandline::ProgramText heel_sim_manual();

}  // namespace heel::sim
