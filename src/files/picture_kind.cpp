#include "files/picture_kind.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>

namespace heel {
namespace {

using namespace std::string_view_literals;

struct Beginning {
  std::string_view bytes;
  const char* kind;
};

constexpr std::array kUnreadablePictures{
    Beginning{"\0\0\0\x0cJXL "sv, "a JPEG XL"},
    Beginning{"\xff\x0a"sv, "a JPEG XL"},
    Beginning{"\0\0\0\x0cjP  "sv, "a JPEG 2000"},
    Beginning{"\xff\x4f\xff\x51"sv, "a JPEG 2000"},
    Beginning{"GIF8"sv, "a GIF"},
    Beginning{"%PDF"sv, "a PDF"},
    Beginning{"II\x2b\0"sv, "a BigTIFF"},
    Beginning{"MM\0\x2b"sv, "a BigTIFF"},
    Beginning{"\x76\x2f\x31\x01"sv, "an OpenEXR"},
    Beginning{"#?RADIANCE"sv, "a Radiance HDR"},
    Beginning{"8BPS"sv, "a Photoshop"},
    Beginning{"gimp xcf"sv, "a GIMP"},
    Beginning{"\x93NUMPY"sv, "a NumPy"},
    Beginning{"SIMPLE  ="sv, "a FITS"},
    Beginning{"<svg"sv, "an SVG"},
    Beginning{"Pf\n"sv, "a PFM"},
    Beginning{"PF\n"sv, "a PFM"},
    Beginning{"P7\n"sv, "a PAM"},
};

constexpr std::array kReadablePictures{
    Beginning{"\xff\xd8\xff"sv, "a JPEG"}, Beginning{"\x89PNG"sv, "a PNG"}, Beginning{"BM"sv, "a BMP"},
    Beginning{"II*\0"sv, "a TIFF"},        Beginning{"MM\0*"sv, "a TIFF"},  Beginning{"P5\n"sv, "a PGM"},
    Beginning{"P2\n"sv, "a PGM"},          Beginning{"P6\n"sv, "a PPM"},    Beginning{"P3\n"sv, "a PPM"},
};

constexpr std::array kVideos{
    Beginning{"\x1a\x45\xdf\xa3"sv, "a Matroska or WebM"},
    Beginning{"FLV\x01"sv, "an FLV"},
    Beginning{"OggS"sv, "an Ogg"},
    Beginning{"YUV4MPEG2 "sv, "a Y4M"},
    Beginning{"\0\0\x01\xba"sv, "an MPEG"},
    Beginning{"\0\0\x01\xb3"sv, "an MPEG"},
};

template <std::size_t Count>
std::string kind_in(const std::array<Beginning, Count>& kinds, ByteView file) {
  const auto found = std::find_if(kinds.begin(), kinds.end(),
                                  [&](const Beginning& kind) { return begins_with(file, kind.bytes); });
  return found == kinds.end() ? "" : found->kind;
}

/// Of the family of MP4; empty for another file.
std::string_view brand_of(ByteView file) {
  if (file.size() < 12 || !begins_with(file.subspan(4), "ftyp")) return "";
  return {reinterpret_cast<const char*>(file.data()) + 8, 4};
}

std::string picture_of_brand(std::string_view brand) {
  for (const char* heic : {"heic", "heix", "heim", "heis", "hevc", "hevx", "mif1", "msf1"})
    if (brand == heic) return "a HEIC";
  for (const char* avif : {"avif", "avis"})
    if (brand == avif) return "an AVIF";
  return brand == "crx " ? "a camera's raw" : "";
}

/// "WEBP" and "AVI " stand behind the size of the file.
bool is_riff(ByteView file, std::string_view kind) {
  return file.size() >= 12 && begins_with(file, "RIFF") && begins_with(file.subspan(8), kind);
}

/// The first chunk says it.
bool is_animated_webp(ByteView file) {
  constexpr std::size_t kFlags = 20;
  return is_riff(file, "WEBPVP8X") && file.size() > kFlags && (file[kFlags] & 0x02) != 0;
}

}  // namespace

std::string unreadable_picture_kind(ByteView file) {
  if (is_animated_webp(file)) return "an animated WebP";
  const std::string by_brand = picture_of_brand(brand_of(file));
  return by_brand.empty() ? kind_in(kUnreadablePictures, file) : by_brand;
}

std::string readable_picture_kind(ByteView file) {
  return is_riff(file, "WEBP") ? "a WebP" : kind_in(kReadablePictures, file);
}

std::string video_kind(ByteView file) {
  if (is_riff(file, "AVI ")) return "an AVI";
  const std::string_view brand = brand_of(file);
  if (!brand.empty() && picture_of_brand(brand).empty()) return "an MP4 or MOV";
  return kind_in(kVideos, file);
}

}  // namespace heel
