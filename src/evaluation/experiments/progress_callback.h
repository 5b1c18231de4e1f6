// Told how far a long experiment is.
#pragma once

#include <cstddef>
#include <functional>

namespace heel::evaluation {

using ProgressCallback = std::function<void(std::size_t done, std::size_t of)>;

}  // namespace heel::evaluation
