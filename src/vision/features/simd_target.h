// The instruction sets vision is compiled for, and which of them it runs with.
#pragma once

#include <string_view>
#include <vector>

namespace heel {

/// Highway's name for the one in use, e.g. "AVX2", "NEON", or "EMU128" for plain SSE2.
const char* simd_target_name();

/// Those compiled in, whether this processor has them or not; best first.
std::vector<std::string_view> compiled_simd_targets();

/// Those of them this processor has; best first, never empty.
std::vector<std::string_view> available_simd_targets();

/// Lets vision run with one of the available only; false, and nothing changed, for any other name. Not while
/// another thread is in a vision stage.
bool use_simd_target(std::string_view name);

/// Undoes that.
void use_best_simd_target();

}  // namespace heel
