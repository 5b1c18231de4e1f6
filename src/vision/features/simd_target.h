// The instruction sets that vision is compiled for, and which of them it uses. Names are those of Highway.
#pragma once

#include <string_view>
#include <vector>

namespace heel {

/// The one in use, e.g. "AVX2", "NEON", or "EMU128" for plain SSE2.
const char* simd_target_name();

/// All that are compiled in, best first.
std::vector<std::string_view> compiled_simd_targets();

/// Those of them that this processor has, best first; never empty.
std::vector<std::string_view> available_simd_targets();

/// Makes vision use the one of this name. False, and nothing is changed, if it is not available. No other
/// thread may be in a vision stage.
bool use_simd_target(std::string_view name);

/// Makes vision use the best available again.
void use_best_simd_target();

}  // namespace heel
