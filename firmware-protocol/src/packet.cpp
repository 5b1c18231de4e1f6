#include "arcos/packet.h"

#include <algorithm>

#include "arcos/checksum.h"

namespace arcos {

const char* to_string(DecodeResult result) {
  switch (result) {
    case DecodeResult::Ok:
      return "ok";
    case DecodeResult::WrongId:
      return "another packet's id";
    case DecodeResult::Truncated:
      return "truncated";
    case DecodeResult::TextTooLong:
      return "string too long";
    case DecodeResult::BadArgumentType:
      return "unknown argument type";
  }
  return "?";
}

Text::Text(std::string_view text) {
  const std::string_view cut = text.substr(0, std::min(text.find('\0'), kCapacity));
  std::copy(cut.begin(), cut.end(), chars_.begin());
  size_ = static_cast<std::uint8_t>(cut.size());
}

PacketWriter::PacketWriter(std::uint8_t id, std::size_t max_count)
    : limit_(kHeaderSize + std::min(max_count, kMaxCount) - kChecksumSize) {
  frame_.bytes_[0] = kHeader0;
  frame_.bytes_[1] = kHeader1;
  frame_.size_ = kHeaderSize;
  u8(id);
}

void PacketWriter::u8(std::uint8_t value) {
  if (frame_.size_ >= limit_) {
    overflow_ = true;
    return;
  }
  frame_.bytes_[frame_.size_++] = value;
}

void PacketWriter::u16(std::uint16_t value) {
  u8(static_cast<std::uint8_t>(value & 0xFF));
  u8(static_cast<std::uint8_t>(value >> 8));
}

void PacketWriter::i32(std::int32_t value) {
  const auto bits = static_cast<std::uint32_t>(value);
  u16(static_cast<std::uint16_t>(bits & 0xFFFF));
  u16(static_cast<std::uint16_t>(bits >> 16));
}

void PacketWriter::raw(std::span<const std::uint8_t> bytes) {
  for (const std::uint8_t byte : bytes) u8(byte);
}

void PacketWriter::raw(std::string_view chars) {
  for (const char c : chars) u8(static_cast<std::uint8_t>(c));
}

void PacketWriter::text(const Text& text) {
  raw(text.view());
  u8(0);
}

Frame PacketWriter::finish() {
  if (overflow_) return Frame{};
  frame_.bytes_[2] = static_cast<std::uint8_t>(frame_.size_ - kHeaderSize + kChecksumSize);
  const std::uint16_t sum =
      checksum(std::span(frame_.bytes_).subspan(kHeaderSize, frame_.size_ - kHeaderSize));
  frame_.bytes_[frame_.size_++] = static_cast<std::uint8_t>(sum >> 8);  // the only big-endian field
  frame_.bytes_[frame_.size_++] = static_cast<std::uint8_t>(sum & 0xFF);
  return frame_;
}

std::uint8_t PacketReader::u8() {
  if (rest_.empty()) {
    truncated_ = true;
    return 0;
  }
  const std::uint8_t value = rest_.front();
  rest_ = rest_.subspan(1);
  return value;
}

std::uint16_t PacketReader::u16() {
  if (rest_.size() < 2) {
    truncated_ = true;
    rest_ = {};
    return 0;
  }
  const std::uint8_t low = u8();
  return static_cast<std::uint16_t>(low | u8() << 8);
}

std::int32_t PacketReader::i32() {
  if (rest_.size() < 4) {
    truncated_ = true;
    rest_ = {};
    return 0;
  }
  const std::uint32_t low = u16();
  return static_cast<std::int32_t>(low | static_cast<std::uint32_t>(u16()) << 16);
}

std::span<const std::uint8_t> PacketReader::raw(std::size_t size) {
  if (rest_.size() < size) {
    truncated_ = true;
    rest_ = {};
    return {};
  }
  const auto taken = rest_.first(size);
  rest_ = rest_.subspan(size);
  return taken;
}

bool PacketReader::holds_text() const {
  return std::find(rest_.begin(), rest_.end(), std::uint8_t{0}) != rest_.end();
}

Text PacketReader::text() {
  const auto end = std::find(rest_.begin(), rest_.end(), std::uint8_t{0});
  const auto size = static_cast<std::size_t>(end - rest_.begin());
  if (end == rest_.end()) {
    truncated_ = true;
    rest_ = {};
    return {};
  }
  if (size > Text::kCapacity) text_too_long_ = true;
  const Text text(std::string_view(reinterpret_cast<const char*>(rest_.data()), size));
  rest_ = rest_.subspan(size + 1);
  return text;
}

DecodeResult PacketReader::result() const {
  if (truncated_) return DecodeResult::Truncated;
  return text_too_long_ ? DecodeResult::TextTooLong : DecodeResult::Ok;
}

Frame frame_body(std::span<const std::uint8_t> body) {
  if (body.empty()) return Frame{};
  PacketWriter writer(body.front());
  writer.raw(body.subspan(1));
  return writer.finish();
}

}  // namespace arcos
