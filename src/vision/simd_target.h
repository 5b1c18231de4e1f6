// Which instruction set Highway has chosen on this machine.
#pragma once

namespace heel {

/// Highway's name for it, e.g. "AVX3" or "SSSE3": what the vision stages run with.
const char* simd_target_name();

}  // namespace heel
