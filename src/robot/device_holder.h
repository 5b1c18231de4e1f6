// Which other program uses a device.
#pragma once

#include <optional>
#include <string>

namespace heel {

struct DeviceHolder {
  int pid = 0;
  std::string program;  ///< its name; empty: not known
};

/// A process other than this one that has locked `path`, or has it open, as far as /proc shows it: what other
/// users' processes have open only root may see, but who holds a lock everybody.
std::optional<DeviceHolder> other_holder_of(const std::string& path);

/// "in use by minicom (process 77); stop it first".
std::string in_use_text(const std::optional<DeviceHolder>& holder);

}  // namespace heel
