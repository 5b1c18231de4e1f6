#include "sim/robot/settings.h"

namespace heel::sim {

P3AtSettings p3at_h8_settings() {
  P3AtSettings settings;
  settings.subtype = "p3at";
  settings.mm_per_position_unit = 0.465;
  settings.heading_from_zero = true;
  settings.sends_fault_flags = false;
  return settings;
}

}  // namespace heel::sim
