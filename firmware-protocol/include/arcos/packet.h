/// \file
/// Packets as bytes: the frame round a body, and the writer and reader that every layout is built from.
///
/// - Convention: on the wire FA FB, count, body (id, payload), checksum high byte, checksum low byte.
///   Integers are little-endian, except for the checksum.
/// - Errors: a body that is too long gives an empty Frame; reading past the end gives
///   DecodeResult::Truncated.
/// - Source: MobileRobots Inc., "Pioneer 3 Operations Manual", 2006, chapter on ARCOS, packet protocols.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace arcos {

inline constexpr std::uint8_t kHeader0 = 0xFA;
inline constexpr std::uint8_t kHeader1 = 0xFB;
inline constexpr std::size_t kHeaderSize = 3;    ///< FA, FB and the count
inline constexpr std::size_t kChecksumSize = 2;  ///< counted by the count
inline constexpr std::size_t kMinCount = 3;      ///< an id and the checksum
inline constexpr std::size_t kMaxCount = 249;    ///< accepted
inline constexpr std::size_t kMaxSentCount = 200;
inline constexpr std::size_t kMaxPacketSize = kHeaderSize + kMaxCount;
inline constexpr std::size_t kMaxBodySize = kMaxCount - kChecksumSize;

/// What a decoder found. Anything but Ok leaves the output's content unspecified.
enum class DecodeResult : std::uint8_t {
  Ok,
  WrongId,          ///< the body is another packet's
  Truncated,        ///< ends before a field that is not optional
  TextTooLong,      ///< a string exceeds Text's capacity
  BadArgumentType,  ///< a command's argument type is none of 3B, 1B, 2B
};
/// As people read it.
const char* to_string(DecodeResult result);

/// A framed packet ready for the wire, in fixed memory. Empty when encoding was refused.
class Frame {
 public:
  std::span<const std::uint8_t> bytes() const { return {bytes_.data(), size_}; }
  std::span<const std::uint8_t> body() const {
    return empty() ? bytes() : bytes().subspan(kHeaderSize, size_ - kHeaderSize - kChecksumSize);
  }
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }

 private:
  friend class PacketWriter;
  std::array<std::uint8_t, kMaxPacketSize> bytes_{};
  std::size_t size_ = 0;
};

/// A short string in fixed memory, as names and versions in packets are.
class Text {
 public:
  static constexpr std::size_t kCapacity = 47;
  Text() = default;
  /// Cut at the capacity and at the first NUL.
  explicit Text(std::string_view text);
  std::string_view view() const { return {chars_.data(), size_}; }
  friend bool operator==(const Text& a, const Text& b) { return a.view() == b.view(); }

 private:
  std::array<char, kCapacity> chars_{};
  std::uint8_t size_ = 0;
};

/// Writes a body field by field and frames it. A body that outgrows `max_count` gives an empty frame.
class PacketWriter {
 public:
  explicit PacketWriter(std::uint8_t id, std::size_t max_count = kMaxCount);
  void u8(std::uint8_t value);
  void u16(std::uint16_t value);
  void i16(std::int16_t value) { u16(static_cast<std::uint16_t>(value)); }
  void i32(std::int32_t value);
  void raw(std::span<const std::uint8_t> bytes);
  void raw(std::string_view chars);
  void text(const Text& text);  ///< with its terminating NUL
  Frame finish();

 private:
  Frame frame_;
  std::size_t limit_ = 0;
  bool overflow_ = false;
};

/// Reads a body field by field. Reading past the end gives 0, and from then on truncated() is true.
class PacketReader {
 public:
  explicit PacketReader(std::span<const std::uint8_t> body) : rest_(body) {}
  std::size_t left() const { return rest_.size(); }
  bool holds_text() const;  ///< a NUL is still to come
  bool truncated() const { return truncated_; }
  std::uint8_t u8();
  std::uint16_t u16();
  std::int16_t i16() { return static_cast<std::int16_t>(u16()); }
  std::int32_t i32();
  std::span<const std::uint8_t> raw(std::size_t size);
  Text text();  ///< up to and with its NUL
  DecodeResult result() const;

 private:
  std::span<const std::uint8_t> rest_;
  bool truncated_ = false;
  bool text_too_long_ = false;
};

/// Frames a whole body (id first). Empty when the body is empty or longer than kMaxBodySize.
Frame frame_body(std::span<const std::uint8_t> body);

}  // namespace arcos
