#include "recording/picture.h"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>
#include <utility>

#include "files/byte_view.h"
#include "files/grey_encoder.h"
#include "files/jpeg_decoder.h"
#include "files/png_picture.h"
#include "heel/error.h"

namespace heel {
namespace {

using PictureJson = nlohmann::ordered_json;

constexpr int kJpegQuality = 85;

constexpr std::string_view kBase64 = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

void append_base64(std::string& text, std::string_view bytes) {
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t word = 0;
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    for (std::size_t k = 0; k < 3; ++k)
      word = word << 8 | (k < count ? static_cast<std::uint8_t>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += k <= count ? kBase64[word >> (18 - 6 * k) & 63] : '=';
  }
}

std::string from_base64(std::string_view text) {
  std::array<int, 256> value{};
  value.fill(-1);
  for (std::size_t i = 0; i < kBase64.size(); ++i)
    value[static_cast<std::uint8_t>(kBase64[i])] = static_cast<int>(i);
  while (text.ends_with('=')) text.remove_suffix(1);
  std::string bytes;
  std::uint32_t word = 0;
  int bits = 0;
  for (const char letter : text) {
    const int six = value[static_cast<std::uint8_t>(letter)];
    if (six < 0) throw Error("data: no base64 text");
    word = word << 6 | static_cast<std::uint32_t>(six);
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes += static_cast<char>(word >> bits & 255);
  }
  return bytes;
}

/// Empty: it is no whole PNG of 8 bits and of that size.
std::vector<std::uint8_t> pixels_in_png(ByteView file, const FrameHeader& header) {
  PngPicture png = decode_png(file);
  if (png.deep || png.width_px != header.width_px || png.height_px != header.height_px) return {};
  return std::move(png.bytes);
}

/// Empty: it is no whole JPEG of that size.
std::vector<std::uint8_t> pixels_in_jpeg(ByteView file, const FrameHeader& header) {
  JpegDecoder decoder;
  std::uint32_t width_px = 0, height_px = 0;
  if (!decoder.read_size(file.data(), file.size(), width_px, height_px) || width_px != header.width_px ||
      height_px != header.height_px)
    return {};
  std::vector<std::uint8_t> pixels(std::size_t{width_px} * height_px);
  if (!decoder.decode(file.data(), file.size(), width_px, height_px, pixels.data())) return {};
  return pixels;
}

}  // namespace

RecordedPicture compressed_picture(const FrameView& frame, bool lossless) {
  return {frame.header, lossless ? "png" : "jpeg",
          lossless ? png_of_grey(frame) : jpeg_of_grey(frame, kJpegQuality)};
}

std::vector<std::uint8_t> picture_pixels(const RecordedPicture& picture) {
  const FrameHeader& header = picture.header;
  const ByteView file(reinterpret_cast<const std::uint8_t*>(picture.bytes.data()), picture.bytes.size());
  std::vector<std::uint8_t> pixels =
      picture.format == "png" ? pixels_in_png(file, header) : pixels_in_jpeg(file, header);
  if (pixels.empty())
    throw Error(fmt::format("frame {}: no {} picture of {}×{} pixels", header.sequence, picture.format,
                            header.width_px, header.height_px));
  return pixels;
}

void append_picture_json(std::string& json, const RecordedPicture& picture, TimeNs t_log_ns) {
  json += fmt::format(
      "{{\"timestamp\":{{\"sec\":{},\"nsec\":{}}},\"frame_id\":\"camera\",\"format\":\"{}\","
      "\"frame_sequence\":{},\"t_capture_ns\":{},\"width_px\":{},\"height_px\":{},\"data\":\"",
      t_log_ns / kNsPerS, t_log_ns % kNsPerS, picture.format, picture.header.sequence,
      picture.header.t_capture_ns, picture.header.width_px, picture.header.height_px);
  append_base64(json, picture.bytes);
  json += "\"}";
}

RecordedPicture picture_from_json(std::string_view text) {
  const PictureJson json = PictureJson::parse(text, nullptr, /*allow_exceptions=*/false);
  try {
    RecordedPicture picture;
    picture.header.sequence = json.at("frame_sequence").get<std::uint64_t>();
    picture.header.t_capture_ns = json.at("t_capture_ns").get<TimeNs>();
    picture.header.width_px = json.at("width_px").get<std::uint32_t>();
    picture.header.height_px = json.at("height_px").get<std::uint32_t>();
    picture.format = json.at("format").get<std::string>();
    picture.bytes = from_base64(json.at("data").get_ref<const std::string&>());
    return picture;
  } catch (const PictureJson::exception& error) {
    throw Error(std::string("no picture: ") + error.what());
  }
}

std::string picture_json_schema() {
  const PictureJson whole{{"type", "integer"}}, text{{"type", "string"}};
  const PictureJson time{{"type", "object"}, {"properties", {{"sec", whole}, {"nsec", whole}}}};
  const PictureJson base64{{"type", "string"}, {"contentEncoding", "base64"}};
  return PictureJson{{"title", "foxglove.CompressedImage"},
                     {"type", "object"},
                     {"properties",
                      {{"timestamp", time},
                       {"frame_id", text},
                       {"data", base64},
                       {"format", text},
                       {"frame_sequence", whole},
                       {"t_capture_ns", whole},
                       {"width_px", whole},
                       {"height_px", whole}}}}
      .dump();
}

}  // namespace heel
