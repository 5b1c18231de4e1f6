#include "files/exif.h"

#include <algorithm>
#include <cstddef>
#include <string_view>

#include "files/orientation.h"

namespace heel {
namespace {

constexpr std::uint16_t kBitsPerSample = 0x0102, kOrientation = 0x0112, kMaxSampleValue = 0x0119,
                        kSampleFormat = 0x0153;
constexpr std::uint32_t kFloatingPoint = 3;
constexpr std::size_t kEntryBytes = 12;

/// The bytes from `at`, `count` of them at most; empty beyond the end.
ByteView part(ByteView bytes, std::size_t at, std::size_t count = SIZE_MAX) {
  if (at >= bytes.size()) return {};
  return bytes.subspan(at, std::min(count, bytes.size() - at));
}

std::uint32_t number(ByteView bytes, std::size_t at, std::size_t count, bool little_endian) {
  const ByteView digits = part(bytes, at, count);
  if (digits.size() < count) return 0;
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < count; ++i) value = value << 8 | digits[little_endian ? count - 1 - i : i];
  return value;
}

int orientation_or_stored(std::uint32_t value) {
  return value >= 1 && value <= 8 ? static_cast<int>(value) : kAsStored;
}

/// Of a whole number; 0 for other types. EXIF has short ones in these tags, and some programs write long
/// ones.
std::size_t bytes_of_type(std::uint32_t type) {
  constexpr std::uint32_t kByte = 1, kShort = 3, kLong = 4;
  return type == kByte ? 1 : type == kShort ? 2 : type == kLong ? 4 : 0;
}

/// The EXIF block of a JPEG: in its APP1 segment, before the picture.
ByteView exif_of_jpeg(ByteView file) {
  for (std::size_t at = 2; at + 4 <= file.size() && file[at] == 0xff;) {
    const std::uint8_t marker = file[at + 1];
    if (marker == 0xff) {  // a fill byte
      ++at;
      continue;
    }
    if (marker == 0xda || marker == 0xd9) return {};
    const std::size_t bytes = number(file, at + 2, 2, false);
    const ByteView segment = part(file, at + 4, std::max<std::size_t>(bytes, 2) - 2);
    if (marker == 0xe1 && begins_with(segment, std::string_view("Exif\0", 5))) return part(segment, 6);
    at += 2 + bytes;
  }
  return {};
}

ByteView exif_of_png(ByteView file) {
  for (std::size_t at = 8; at + 8 <= file.size();) {
    const std::size_t bytes = number(file, at, 4, false);
    if (begins_with(part(file, at + 4), "eXIf")) return part(file, at + 8, bytes);
    at += 12 + bytes;
  }
  return {};
}

ByteView exif_of_webp(ByteView file) {
  for (std::size_t at = 12; at + 8 <= file.size();) {
    const std::size_t bytes = number(file, at + 4, 4, true);
    if (begins_with(part(file, at), "EXIF")) {
      const ByteView block = part(file, at + 8, bytes);
      return begins_with(block, std::string_view("Exif\0", 5)) ? part(block, 6) : block;
    }
    at += 8 + bytes + bytes % 2;
  }
  return {};
}

}  // namespace

TiffTags read_tiff_tags(ByteView tiff) {
  TiffTags tags;
  const bool little_endian = begins_with(tiff, "II");
  if (!little_endian && !begins_with(tiff, "MM")) return tags;
  const std::size_t directory = number(tiff, 4, 4, little_endian);
  const std::size_t entries = number(tiff, directory, 2, little_endian);
  for (std::size_t i = 0; i < entries; ++i) {
    const std::size_t at = directory + 2 + i * kEntryBytes;
    if (part(tiff, at, kEntryBytes).size() < kEntryBytes) break;
    const std::uint32_t tag = number(tiff, at, 2, little_endian);
    const std::uint32_t count = number(tiff, at + 4, 4, little_endian);
    const std::size_t bytes = bytes_of_type(number(tiff, at + 2, 2, little_endian));
    if (bytes == 0 || count == 0) continue;
    // Up to four bytes stand in the entry itself, more of them where it points.
    const std::size_t values = count <= 4 / bytes ? at + 8 : number(tiff, at + 8, 4, little_endian);
    const std::uint32_t value = number(tiff, values, bytes, little_endian);
    if (tag == kOrientation) {
      tags.orientation = orientation_or_stored(value);
      tags.orientation_at = values;
      tags.orientation_bytes = bytes;
    }
    constexpr std::uint32_t kMost = 0xffff;
    if (tag == kMaxSampleValue) tags.max_sample_value = static_cast<int>(std::min(value, kMost));
    if (tag == kBitsPerSample) tags.bits = static_cast<int>(std::min(value, kMost));
    if (tag == kSampleFormat) tags.has_floats = value == kFloatingPoint;
  }
  return tags;
}

int orientation_in_file(ByteView file) {
  if (begins_with(file, "\xff\xd8")) return read_tiff_tags(exif_of_jpeg(file)).orientation;
  if (begins_with(file, "\x89PNG")) return read_tiff_tags(exif_of_png(file)).orientation;
  if (begins_with(file, "RIFF")) return read_tiff_tags(exif_of_webp(file)).orientation;
  return read_tiff_tags(file).orientation;
}

}  // namespace heel
