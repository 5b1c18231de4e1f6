// One line of comma-separated values, built without allocating. Numbers are written so that reading them back
// gives the same value, in no locale.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "heel/time.h"

namespace heel {

class CsvLine {
 public:
  void clear() { size_ = 0; }

  void number(double value);  ///< shortest text that reads back the same; nan where there is no value
  void integer(std::int64_t value);
  void integer(std::uint64_t value);
  void flag(bool value) { integer(std::uint64_t{value ? 1u : 0u}); }
  void seconds(TimeNs t_ns);          ///< exact: seconds with nine decimals
  void text(std::string_view value);  ///< commas, quotes and line ends become spaces

  /// The line with its line end, valid until the next member is called.
  std::string_view finish();

 private:
  void begin_cell();
  void put(char c);
  void put(std::string_view characters);

  static constexpr std::size_t kCapacity = 4096;
  std::array<char, kCapacity> bytes_{};
  std::size_t size_ = 0;
};

}  // namespace heel
