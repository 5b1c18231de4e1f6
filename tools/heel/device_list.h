// The cameras and serial lines that this computer has, for people to choose from.
#pragma once

#include <string>
#include <vector>

namespace heel::cli {

struct ListedDevice {
  std::string path;  ///< one that stays the same when the device is plugged in again, where udev has made one
  std::string name;
};

/// Video devices that give pictures; a camera has others for its metadata.
std::vector<ListedDevice> video_devices();

/// /dev/heel-robot, then USB serial lines.
std::vector<std::string> serial_devices();

}  // namespace heel::cli
