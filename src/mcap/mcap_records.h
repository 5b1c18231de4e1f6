// The records of an MCAP file (mcap.dev/spec, version 0): operation codes, and their fields as bytes. All
// numbers are little-endian; a text is its length in four bytes, then UTF-8.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "heel/time.h"

namespace heel {

inline constexpr std::array<char, 8> kMcapMagic{'\x89', 'M', 'C', 'A', 'P', '0', '\r', '\n'};
inline constexpr std::size_t kMcapRecordHeadBytes = 9;  ///< operation code and length

enum class McapOp : std::uint8_t {
  Header = 0x01,
  Footer = 0x02,
  Schema = 0x03,
  Channel = 0x04,
  Message = 0x05,
  Chunk = 0x06,
  MessageIndex = 0x07,
  ChunkIndex = 0x08,
  Attachment = 0x09,
  AttachmentIndex = 0x0a,
  Statistics = 0x0b,
  Metadata = 0x0c,
  MetadataIndex = 0x0d,
  SummaryOffset = 0x0e,
  DataEnd = 0x0f,
};

struct McapSchema {
  std::uint16_t id = 0;  ///< from 1 on; 0: no schema
  std::string name;
  std::string encoding;  ///< "jsonschema"
  std::string text;
};

struct McapChannel {
  std::uint16_t id = 0;
  std::uint16_t schema = 0;
  std::string topic;
  std::string encoding;  ///< "json"
  std::map<std::string, std::string> metadata;
};

/// `data` is valid until the next message is read.
struct McapMessage {
  std::uint16_t channel = 0;
  std::uint32_t sequence = 0;
  TimeNs t_log_ns = 0;
  TimeNs t_publish_ns = 0;
  std::string_view data;
};

/// Appends the fields of a record.
class McapFields {
 public:
  explicit McapFields(std::string& bytes) : bytes_(bytes) {}

  void u8(std::uint8_t value) { bytes_.push_back(static_cast<char>(value)); }
  void u16(std::uint64_t value) { number(value, 2); }
  void u32(std::uint64_t value) { number(value, 4); }
  void u64(std::uint64_t value) { number(value, 8); }
  void time(TimeNs t_ns) { u64(t_ns < 0 ? 0 : static_cast<std::uint64_t>(t_ns)); }
  void text(std::string_view value) {
    u32(value.size());
    bytes_.append(value);
  }

 private:
  void number(std::uint64_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) bytes_.push_back(static_cast<char>(value >> (8 * i)));
  }
  std::string& bytes_;
};

/// Takes the fields of a record; after one that does not fit, ok() is false and all further ones are empty.
class McapFieldReader {
 public:
  explicit McapFieldReader(std::string_view bytes) : bytes_(bytes) {}

  bool ok() const { return ok_; }
  bool at_end() const { return bytes_.empty(); }
  std::uint8_t u8() { return static_cast<std::uint8_t>(number(1)); }
  std::uint16_t u16() { return static_cast<std::uint16_t>(number(2)); }
  std::uint32_t u32() { return static_cast<std::uint32_t>(number(4)); }
  std::uint64_t u64() { return number(8); }
  TimeNs time() { return static_cast<TimeNs>(u64()); }
  std::string_view text() { return take(u32()); }
  std::string_view take(std::uint64_t count) {
    if (count > bytes_.size()) {
      ok_ = false;
      bytes_ = {};
      return {};
    }
    const std::string_view part = bytes_.substr(0, count);
    bytes_.remove_prefix(count);
    return part;
  }
  std::string_view rest() { return take(bytes_.size()); }

 private:
  std::uint64_t number(std::size_t count) {
    const std::string_view part = take(count);
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < part.size(); ++i)
      value |= std::uint64_t{static_cast<std::uint8_t>(part[i])} << (8 * i);
    return value;
  }
  std::string_view bytes_;
  bool ok_ = true;
};

/// CRC-32 as zlib has it; 0 for no bytes.
std::uint32_t mcap_crc(std::string_view bytes);
/// Continues the sum of the bytes before.
std::uint32_t mcap_crc(std::string_view bytes, std::uint32_t before);

}  // namespace heel
