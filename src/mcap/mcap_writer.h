// Writes an MCAP file (mcap.dev/spec, version 0) piece by piece: messages are gathered in chunks, each with
// its checksum and its index, and the end has a summary. A file without its end reads to its last chunk.
//
//   McapWriter writer([&](std::string_view piece) { return file.append(piece); }, {});
//   const auto channel = writer.add_channel("/heel/tick", writer.add_schema("heel.Tick", "jsonschema",
//   text)); writer.write(channel, t_ns, json);   writer.end_chunk();   …   writer.finish();
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "mcap/mcap_records.h"

namespace heel {

struct McapOptions {
  std::string library = "heel";       ///< who wrote the file
  std::size_t chunk_bytes = 1 << 20;  ///< a chunk ends when it has so many, uncompressed …
  TimeNs chunk_ns = kNsPerS;          ///< … or when the next message is so much later than its first
  int compression_level = 1;          ///< of zstd
};

class McapWriter {
 public:
  /// Takes a piece of the file, whole or not at all. False: it could not; then the messages of that piece are
  /// counted as lost, and the file goes on without it.
  using Sink = std::function<bool(std::string_view piece)>;

  McapWriter(Sink sink, McapOptions options);
  ~McapWriter();
  McapWriter(const McapWriter&) = delete;
  McapWriter& operator=(const McapWriter&) = delete;

  // Schemas and channels stand outside of chunks: a chunk that is lost takes none with it.
  std::uint16_t add_schema(const std::string& name, const std::string& encoding, const std::string& text);
  std::uint16_t add_channel(const std::string& topic, std::uint16_t schema,
                            const std::string& encoding = "json");
  void write(std::uint16_t channel, TimeNs t_log_ns, std::string_view data);
  /// False: the sink refused it; it is counted as lost.
  bool add_attachment(const std::string& name, const std::string& media_type, std::string_view data,
                      TimeNs t_log_ns);

  /// Hands what is gathered to the sink. For times at which no message comes.
  void end_chunk();
  /// The first message of the chunk that is being gathered; 0: none is.
  TimeNs chunk_begin_ns() const { return chunk_.empty() ? 0 : t_chunk_begin_ns_; }
  /// The last chunk, the summary and the end. Nothing may be written after it.
  void finish();

  std::uint64_t messages() const { return messages_; }            ///< handed to the sink
  std::uint64_t messages_lost() const { return messages_lost_; }  ///< in pieces that the sink refused
  std::uint64_t attachments_lost() const { return attachments_lost_; }
  std::uint64_t bytes() const { return offset_; }

 private:
  struct IndexEntry {
    TimeNs t_log_ns;
    std::uint64_t offset;
  };
  struct ChunkIndex {
    TimeNs t_begin_ns, t_end_ns;
    std::uint64_t offset, bytes, index_bytes, compressed_bytes, uncompressed_bytes;
    std::map<std::uint16_t, std::uint64_t> index_offsets;  // of the file, by channel
  };
  struct AttachmentIndex {
    std::uint64_t offset, bytes, data_bytes;
    TimeNs t_log_ns;
    std::string name, media_type;
  };
  struct Compressor;

  bool emit(std::string_view piece);
  std::string compressed(std::string_view records);
  std::string summary(std::uint64_t begin) const;

  Sink sink_;
  const McapOptions options_;
  std::unique_ptr<Compressor> compressor_;
  std::uint64_t offset_ = 0;  // of the next piece
  bool finished_ = false;

  std::vector<McapSchema> schemas_;
  std::vector<McapChannel> channels_;
  std::vector<std::uint32_t> sequences_;       // by channel
  std::vector<std::uint64_t> channel_counts_;  // by channel: messages handed to the sink
  std::vector<ChunkIndex> chunks_;
  std::vector<AttachmentIndex> attachments_;

  std::string chunk_;  // the records being gathered
  TimeNs t_chunk_begin_ns_ = 0, t_chunk_end_ns_ = 0;
  std::map<std::uint16_t, std::vector<IndexEntry>> chunk_index_;

  TimeNs t_begin_ns_ = 0, t_end_ns_ = 0;
  std::uint64_t messages_ = 0;
  std::uint64_t messages_lost_ = 0;
  std::uint64_t attachments_lost_ = 0;
};

}  // namespace heel
