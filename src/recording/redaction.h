// Private names taken out of texts that leave the robot: host name, user names, serial numbers of devices.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace heel {

class Redaction {
 public:
  /// `name` becomes `instead` where it stands as a word. Empty names are ignored.
  void add_word(const std::string& name, const std::string& instead);

  /// The text without these words; in addition the name behind "/home/" becomes USER, that of a device behind
  /// "/by-id/", which holds its serial number, becomes DEVICE, and the host of "tcp:HOST:PORT",
  /// "tcp://HOST:PORT" and "ssl://HOST:PORT" becomes HOST.
  std::string applied(std::string_view text) const;
  /// Of a configuration, only inside quoted values and comments, so that sections and keys keep their names.
  /// The value of a key "user" becomes USER. Another value that is neither a path nor an address, as "jpeg",
  /// stays as well: it is the choice of a key.
  std::string applied_to_toml(std::string_view toml) const;

 private:
  std::vector<std::pair<std::string, std::string>> words_;
};

}  // namespace heel
