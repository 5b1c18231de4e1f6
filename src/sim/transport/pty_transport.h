// A pseudo-terminal whose client side is found under a symlink of the user's choice.
//
// The master stays open while clients come and go. The terminal starts raw and at the robot's boot rate, and
// keeps what a client has set, as a real port's driver would: a client that sets no rate agrees with the
// robot until somebody changes one of them.
#pragma once

#include "sim/transport/file_descriptor.h"
#include "sim/transport/transport.h"

namespace heel::sim {

class PtyTransport : public Transport {
 public:
  /// Replaces a symlink left at `link_path`; throws heel::Error when something else is there.
  PtyTransport(const std::string& link_path, int boot_baud);
  ~PtyTransport() override;  ///< removes the symlink if it is still ours

  bool client_present() override;
  std::size_t read(std::span<std::uint8_t> into) override;
  void write(std::span<const std::uint8_t> bytes) override;
  int host_baud() const override;
  std::string address() const override { return "pty:" + link_path_; }

 private:
  void discard_unread();

  std::string link_path_;
  std::string slave_path_;
  FileDescriptor master_;
  bool client_was_present_ = false;
};

}  // namespace heel::sim
