// One line of comma-separated values, built without allocation. Numbers are written independently of the
// locale, and reading them back gives the same value.
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

  void number(double value);  ///< the shortest text that reads back the same; NaN becomes nan
  void integer(std::int64_t value);
  void integer(std::uint64_t value);
  void flag(bool value) { integer(std::uint64_t{value ? 1u : 0u}); }
  void seconds(TimeNs t_ns);          ///< seconds with nine decimals, exact
  void text(std::string_view value);  ///< commas, quotes and line ends become spaces

  /// The line with its line end; valid until the next call.
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
