// A pseudo-terminal; its client side is at a symlink with a path that the user chooses.
//
// The master stays open while clients connect and disconnect. The terminal starts raw and at the robot's boot
// rate, and keeps a client's settings, as the driver of a real port does: a client that sets no rate has the
// robot's rate until one of the two is changed.
#pragma once

#include "sim/transport/file_descriptor.h"
#include "sim/transport/name_guard.h"
#include "sim/transport/transport.h"

namespace heel::sim {

class PtyTransport : public Transport {
 public:
  /// Replaces a symlink that is left at `link_path`; throws heel::Error when there is anything else, or when
  /// another heel-sim serves it.
  PtyTransport(const std::string& link_path, int boot_baud);
  ~PtyTransport() override;  ///< removes the symlink if it still leads to this terminal

  bool client_present() override;
  std::size_t read(std::span<std::uint8_t> into) override;
  void write(std::span<const std::uint8_t> bytes) override;
  int host_baud() const override;
  std::string address() const override { return "pty:" + link_path_; }

 private:
  void discard_unread();

  std::string link_path_;
  NameGuard guard_;
  std::string slave_path_;
  FileDescriptor master_;
  bool client_was_present_ = false;
};

}  // namespace heel::sim
