// The likely cause when a serial line cannot be opened, and what to do.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace heel {

/// True for the client's end of a pseudo-terminal.
bool is_pty(const std::string& path);

/// Why a device that exists was not opened, from the errno: "cannot open: Permission denied: …".
std::string open_failure_text(const std::string& path, int error);

/// "cannot open: No such file or directory", and the adapters in `by_id`, by names that stay the same on any
/// port.
std::string missing_device_text(const std::string& by_id = "/dev/serial/by-id");

/// A USB adapter: what it is, not where it is plugged in.
struct UsbAdapter {
  std::string device;  ///< "/dev/ttyUSB0"
  int vendor = 0, product = 0;
  std::string serial;  ///< empty: it has none

  bool is_same_as(const UsbAdapter& other) const {
    return vendor == other.vendor && product == other.product && serial == other.serial;
  }
};

/// The adapter of the device; nothing when it is none on USB.
std::optional<UsbAdapter> usb_adapter_of(const std::string& device);
std::vector<UsbAdapter> usb_adapters();

/// Where `gone` is plugged in now: the only adapter in `present` that is the same.
std::optional<UsbAdapter> moved_to(const UsbAdapter& gone, const std::vector<UsbAdapter>& present);

}  // namespace heel
