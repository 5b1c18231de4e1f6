#include "sim/transport/wire_file.h"

#include <fmt/ranges.h>

namespace heel::sim {

void WireFile::write(TimeNs t_ns, std::span<const std::uint8_t> bytes) {
  file_.print("{:.{}f} {:02x}\n", seconds_from_ns(t_ns), decimals_, fmt::join(bytes, ""));
}

}  // namespace heel::sim
