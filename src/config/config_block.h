// The block of values that `heel tune` has found, in a configuration file. A person sees at once which values
// nobody chose by hand, where they come from, and what they replaced:
//
//   [control]
//   law = "view"
//   # (before heel tune) gain_yaw_1_s = 1.0  # mine
//   # >>> heel tune
//   # 2026-11-30; scenarios gait, walk; seeds 1 to 4; cost 3.21, before 4.02
//   gain_yaw_1_s = 0.71
//   # <<< heel tune
#pragma once

#include <span>
#include <string>
#include <vector>

#include "config/config_set.h"

namespace heel {

/// `text` of the configuration file `file` with the values `ConfigChange::after` of keys of one section, in a
/// block at the end of that section. `about`: lines of the block's comment, without "# ". Lines that set
/// these keys become comments; an earlier block is replaced, and its other keys are kept in the new one.
/// All else stays as it is. Throws heel::Error with one line when the text is no configuration, when a
/// block has no end, or when a key does not stand on a line of its own.
std::string config_text_with_block(const std::string& text, const std::string& file,
                                   std::span<const ConfigChange> changes,
                                   const std::vector<std::string>& about);

}  // namespace heel
