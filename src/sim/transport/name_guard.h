// Holds a name for this process as long as it runs, so that a second heel-sim does not take the first one's
// pty away from its clients. An abstract socket: it ends with the process, whatever ends it, and leaves no
// file.
#pragma once

#include <string>

#include "sim/transport/file_descriptor.h"

namespace heel::sim {

class NameGuard {
 public:
  /// Throws heel::Error "WHAT: heel-sim (process N) serves it already …" when another process holds `name`.
  NameGuard(const std::string& name, const std::string& what);

 private:
  FileDescriptor socket_;
};

}  // namespace heel::sim
