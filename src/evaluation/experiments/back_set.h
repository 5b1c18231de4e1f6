// A test set of pictures of backs with truth, rendered by our own simulator: images/, truth.csv and
// camera.yaml, as in the set of pictures that others' programs made (docs/experiments.md compares the two).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

namespace heel::evaluation {

/// Writes the set into `folder`; the same seed gives the same pictures to the bit. `on_progress` may be
/// empty. Throws heel::Error when something cannot be written. Returns the number of pictures.
std::size_t write_back_set(const std::string& folder, std::uint64_t seed,
                           const std::function<void(std::size_t done)>& on_progress);

}  // namespace heel::evaluation
