// A terminal's rate in bit/s as a number. On its own because the kernel's header for it (any rate, not only
// the named ones) and <termios.h> cannot be included together.
#pragma once

namespace heel::sim {

/// The output rate; 0 when it is not a terminal or hangs up (B0). Of a pty's master: what the client has set.
int terminal_rate(int fd);

}  // namespace heel::sim
