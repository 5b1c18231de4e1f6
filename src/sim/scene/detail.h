// What a world is made for.
#pragma once

#include <cstdint>

namespace heel::sim {

enum class Detail : std::uint8_t {
  Pictures,   ///< everything
  TruthOnly,  ///< nothing is drawn: no prints, no room, no camera; a thousandth of the time to make
};

}  // namespace heel::sim
