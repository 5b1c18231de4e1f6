// A terminal's rate in bit/s, whatever number it is. A file of its own, because the kernel's header for it
// and <termios.h>, which knows the named rates only, cannot be included together.
#pragma once

namespace heel::sim {

/// The output rate; 0 when `fd` is no terminal or its rate is "hang up" (B0). For a pty's master: the rate
/// that the client has set.
int terminal_rate(int fd);

}  // namespace heel::sim
