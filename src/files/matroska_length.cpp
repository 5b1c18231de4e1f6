#include "files/matroska_length.h"

#include <bit>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace heel {
namespace {

constexpr std::uint64_t kHead = 0x1A45DFA3, kSegment = 0x18538067;
constexpr std::uint64_t kVoid = 0xEC, kChecksum = 0xBF;
constexpr int kMostElements = 16;  // before the Segment; a muxer writes one, or two

/// A number of 1 to 8 bytes: the zeros before its first one say how many follow. `bits`: those of its value.
struct Vint {
  std::uint64_t raw = 0;  ///< with the first one
  int bits = 0;           ///< 0: there is none

  std::uint64_t value() const { return raw & ((std::uint64_t{1} << bits) - 1); }
  bool is_unknown() const { return value() == (std::uint64_t{1} << bits) - 1; }
};

Vint read_vint(std::istream& file) {
  Vint out;
  const int first = file.get();
  if (first <= 0) return out;  // the end, or a number of more than 8 bytes
  const int more = std::countl_zero(static_cast<std::uint8_t>(first));
  out.raw = static_cast<std::uint64_t>(first);
  for (int i = 0; i < more; ++i) out.raw = out.raw << 8 | static_cast<std::uint64_t>(file.get() & 0xff);
  if (file) out.bits = 7 * (more + 1);
  return out;
}

}  // namespace

std::uint64_t matroska_segment_end(std::istream& file) {
  for (int i = 0; i < kMostElements; ++i) {
    const Vint id = read_vint(file), size = read_vint(file);
    const bool is_expected =
        i == 0 ? id.raw == kHead : id.raw == kSegment || id.raw == kVoid || id.raw == kChecksum;
    if (size.bits == 0 || size.is_unknown() || !is_expected) return 0;
    // A size of 0 is a place that the program was to fill in at the end.
    if (id.raw == kSegment && size.value() == 0) return 0;
    if (id.raw == kSegment) return static_cast<std::uint64_t>(file.tellg()) + size.value();
    file.seekg(static_cast<std::streamoff>(size.value()), std::ios::cur);
  }
  return 0;
}

StatedLength matroska_length(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::uint64_t stated = matroska_segment_end(file);
  std::error_code error;
  const std::uint64_t bytes = std::filesystem::file_size(path, error);
  if (stated == 0 || error) return StatedLength::Unknown;
  return bytes < stated ? StatedLength::Short : StatedLength::Complete;
}

}  // namespace heel
