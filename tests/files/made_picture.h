// Bytes of pictures that no library writes so: PNG chunks, TIFF files, EXIF blocks.
#pragma once

#include <zlib.h>

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace heel {

inline std::string big_endian(std::uint32_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 0xff);
  return bytes;
}

inline std::string little_endian(std::uint32_t value, int count = 4) {
  std::string bytes;
  for (int i = 0; i < count; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xff);
  return bytes;
}

/// An EXIF block that has an orientation alone, as a long number.
inline std::string exif_block_with_long(int orientation) {
  return "MM" + std::string("\0\x2a", 2) + big_endian(8) + std::string("\0\x01\x01\x12\0\x04", 6) +
         big_endian(1) + big_endian(static_cast<std::uint32_t>(orientation)) + big_endian(0);
}

/// The same as a short number.
inline std::string exif_block(int orientation, bool little = false) {
  if (little)
    return "II" + little_endian(42, 2) + little_endian(8) + little_endian(1, 2) + little_endian(0x112, 2) +
           little_endian(3, 2) + little_endian(1) + little_endian(static_cast<std::uint32_t>(orientation)) +
           little_endian(0);
  return "MM" + std::string("\0\x2a", 2) + big_endian(8) + std::string("\0\x01\x01\x12\0\x03", 6) +
         big_endian(1) + std::string(1, '\0') + static_cast<char>(orientation) + std::string(2, '\0') +
         big_endian(0);
}

inline std::string png_chunk(const std::string& name, const std::string& data) {
  const std::string body = name + data;
  const auto sum = crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size()));
  return big_endian(static_cast<std::uint32_t>(data.size())) + body +
         big_endian(static_cast<std::uint32_t>(sum));
}

inline constexpr std::size_t kPngHeaderBytes = 8 + 25;  // the signature and the first chunk

/// A TIFF file, uncompressed, with one strip. `orientation_type`: 3 a short number, 4 a long one.
inline std::string tiff_of(const cv::Mat& picture, int orientation, std::uint32_t orientation_type = 3) {
  struct Entry {
    std::uint32_t tag, type, value;
  };
  const auto rows = static_cast<std::uint32_t>(picture.rows),
             columns = static_cast<std::uint32_t>(picture.cols);
  const auto bytes = static_cast<std::uint32_t>(picture.total() * picture.elemSize());
  const std::vector<Entry> entries{{0x100, 3, columns},
                                   {0x101, 3, rows},
                                   {0x102, 3, static_cast<std::uint32_t>(8 * picture.elemSize())},
                                   {0x103, 3, 1},
                                   {0x106, 3, 1},
                                   {0x111, 4, 8},
                                   {0x112, orientation_type, static_cast<std::uint32_t>(orientation)},
                                   {0x115, 3, 1},
                                   {0x116, 3, rows},
                                   {0x117, 4, bytes},
                                   {0x153, 3,
                                    picture.depth() == CV_32F   ? 3U
                                    : picture.depth() == CV_16S ? 2U
                                                                : 1U}};
  std::string file = "II" + little_endian(42, 2) + little_endian(8 + bytes);
  file.append(reinterpret_cast<const char*>(picture.data), bytes);
  file += little_endian(static_cast<std::uint32_t>(entries.size()), 2);
  for (const Entry& entry : entries)
    file += little_endian(entry.tag, 2) + little_endian(entry.type, 2) + little_endian(1) +
            little_endian(entry.value);
  return file + little_endian(0);
}

/// Of 8 or 16 bits, not filtered; `samples`: the pixels, row by row. `before`: chunks before them.
inline std::string png_of(std::uint32_t width_px, std::uint32_t height_px, char bits, char colour_type,
                          const std::string& samples, const std::string& before = "") {
  std::string rows;
  const std::size_t row_bytes = samples.size() / height_px;
  for (std::size_t y = 0; y < height_px; ++y) rows += '\0' + samples.substr(y * row_bytes, row_bytes);
  uLongf size = compressBound(static_cast<uLong>(rows.size()));
  std::string packed(size, '\0');
  compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(rows.data()),
           static_cast<uLong>(rows.size()));
  packed.resize(size);
  const std::string header =
      big_endian(width_px) + big_endian(height_px) + bits + colour_type + std::string(3, '\0');
  return "\x89PNG\r\n\x1a\n" + png_chunk("IHDR", header) + before + png_chunk("IDAT", packed) +
         png_chunk("IEND", "");
}

}  // namespace heel
