// The robot's serial number and name in the bytes on its line, taken out: they stand in CONFIGpac, the name
// also in the echo of SYNC2. A packet may be cut over several messages.
//
//   PrivateWire wire;
//   for (each message of /heel/wire) wire.add(json);   wire.finish();
//   wire.without_names(0, json_of_the_first)           // the same message, with '-' in place of each letter
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace heel {

class PrivateWire {
 public:
  /// The next message, in the order of the recording.
  void add(std::string_view json);
  /// There are no more: also looks at a packet that has no end.
  void finish();
  /// The message of that number, counted from 0, with the checksum of its packet right where it was before.
  /// Nothing: it cannot be read, so nobody knows what is in it.
  std::optional<std::string> without_names(std::size_t message, std::string_view json) const;

 private:
  struct Piece {
    std::uint64_t begin = 0;
    std::uint8_t count = 0;  ///< 0 also for bytes to the robot
    bool readable = true;
  };
  void search(bool at_end);
  bool take_packet(std::span<const std::uint8_t> packet, bool whole);

  std::vector<Piece> pieces_;                      // by message
  std::vector<std::uint8_t> rest_;                 // from the robot, not yet decided
  std::uint64_t rest_begin_ = 0;                   // of rest_ in all bytes from the robot
  std::map<std::uint64_t, std::uint8_t> instead_;  // by place in all bytes from the robot
};

}  // namespace heel
