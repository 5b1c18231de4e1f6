// Reads an MCAP file from its beginning to its end, without its index, so that a file without an end (power
// cut) reads like a whole one. Chunks may be uncompressed or compressed with zstd.
//
//   std::ifstream file(path, std::ios::binary);
//   McapReader reader(file, path);            // throws heel::Error when it is no MCAP file
//   for (McapMessage message; reader.next(message);) use(reader.channel(message.channel).topic, message);
//   if (!reader.problems().empty()) …         // what is damaged or missing, and where
#pragma once

#include <cstdint>
#include <istream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "mcap/mcap_records.h"

namespace heel {

struct McapAttachment {
  std::string name;
  std::string media_type;
  std::string data;
};

class McapReader {
 public:
  /// A record that says it is longer is taken for damage: nothing that we write is.
  static constexpr std::uint64_t kMaxRecordBytes = 1 << 28;

  /// `file` is borrowed; `name` stands for it in messages. Throws heel::Error when it does not begin as an
  /// MCAP file does.
  McapReader(std::istream& file, std::string name);
  ~McapReader();
  McapReader(const McapReader&) = delete;
  McapReader& operator=(const McapReader&) = delete;

  /// The next message in the order of the file. A chunk that is damaged is left out, and problems() says so.
  /// False: the end.
  bool next(McapMessage& message);

  /// Of a message that was read. Throws heel::Error when the file has no such channel.
  const McapChannel& channel(std::uint16_t id) const;
  /// Of a channel; null: it has none.
  const McapSchema* schema(std::uint16_t id) const;
  const std::map<std::uint16_t, McapChannel>& channels() const { return channels_; }
  const std::map<std::string, McapAttachment>& attachments() const { return attachments_; }

  /// One line each, with the place: "run.mcap: byte 1234: …".
  const std::vector<std::string>& problems() const { return problems_; }
  /// The end of the file was read: it was closed, not cut off.
  bool complete() const { return complete_; }

 private:
  struct Decompressor;

  bool read_record();
  void read_chunk(std::string_view body);
  bool next_in_chunk(McapMessage& message);
  void take_schema(std::string_view body);
  void take_channel(std::string_view body);
  void take_attachment(std::string_view body);
  bool take_message(std::string_view body, McapMessage& message);
  bool cut_off(const std::string& what);
  void complain(const std::string& what);

  std::istream& file_;
  const std::string name_;
  std::unique_ptr<Decompressor> decompressor_;
  std::uint64_t offset_ = 0;  // of the record being read
  bool ended_ = false;
  bool complete_ = false;
  std::uint64_t messages_ = 0;

  McapOp op_{};           // of the record read last …
  std::string body_;      // … and its content
  std::string chunk_;     // the records of the chunk read last, uncompressed …
  std::size_t next_ = 0;  // … and the next of them

  std::map<std::uint16_t, McapSchema> schemas_;
  std::map<std::uint16_t, McapChannel> channels_;
  std::map<std::string, McapAttachment> attachments_;
  std::vector<std::string> problems_;
};

}  // namespace heel
