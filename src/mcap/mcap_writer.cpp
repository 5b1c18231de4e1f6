#include "mcap/mcap_writer.h"

#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <utility>

#include "heel/error.h"

namespace heel {
namespace {

constexpr std::uint64_t kFooterBytes = 20;

/// A whole record.
template <typename Body>
void append_record(std::string& bytes, McapOp op, const Body& body) {
  const std::size_t begin = bytes.size();
  McapFields fields(bytes);
  fields.u8(static_cast<std::uint8_t>(op));
  fields.u64(0);  // the length, below
  body(fields);
  std::string length;
  McapFields(length).u64(bytes.size() - begin - kMcapRecordHeadBytes);
  bytes.replace(begin + 1, length.size(), length);
}

/// A list or a map: its bytes, after their number.
template <typename Body>
void append_sized(McapFields& fields, const Body& body) {
  std::string bytes;
  McapFields inner(bytes);
  body(inner);
  fields.text(bytes);
}

void append_schema(std::string& bytes, const McapSchema& schema) {
  append_record(bytes, McapOp::Schema, [&](McapFields& fields) {
    fields.u16(schema.id);
    fields.text(schema.name);
    fields.text(schema.encoding);
    fields.text(schema.text);
  });
}

void append_channel(std::string& bytes, const McapChannel& channel) {
  append_record(bytes, McapOp::Channel, [&](McapFields& fields) {
    fields.u16(channel.id);
    fields.u16(channel.schema);
    fields.text(channel.topic);
    fields.text(channel.encoding);
    append_sized(fields, [&](McapFields& map) {
      for (const auto& [key, value] : channel.metadata) {
        map.text(key);
        map.text(value);
      }
    });
  });
}

}  // namespace

std::uint32_t mcap_crc(std::string_view bytes, std::uint32_t before) {
  return static_cast<std::uint32_t>(
      crc32_z(before, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

std::uint32_t mcap_crc(std::string_view bytes) {
  return mcap_crc(bytes, 0);
}

struct McapWriter::Compressor {
  ZSTD_CCtx* context = ZSTD_createCCtx();
  Compressor() {
    if (context == nullptr) throw Error("zstd: no memory for a compressor");
  }
  ~Compressor() { ZSTD_freeCCtx(context); }
  Compressor(const Compressor&) = delete;
  Compressor& operator=(const Compressor&) = delete;
};

McapWriter::McapWriter(Sink sink, McapOptions options)
    : sink_(std::move(sink)), options_(std::move(options)), compressor_(std::make_unique<Compressor>()) {
  std::string bytes(kMcapMagic.data(), kMcapMagic.size());
  append_record(bytes, McapOp::Header, [&](McapFields& fields) {
    fields.text("");  // no profile
    fields.text(options_.library);
  });
  emit(bytes);
}

McapWriter::~McapWriter() = default;

bool McapWriter::emit(std::string_view piece) {
  if (!sink_(piece)) return false;
  offset_ += piece.size();
  return true;
}

std::uint16_t McapWriter::add_schema(const std::string& name, const std::string& encoding,
                                     const std::string& text) {
  schemas_.push_back({static_cast<std::uint16_t>(schemas_.size() + 1), name, encoding, text});
  std::string bytes;
  append_schema(bytes, schemas_.back());
  emit(bytes);
  return schemas_.back().id;
}

std::uint16_t McapWriter::add_channel(const std::string& topic, std::uint16_t schema,
                                      const std::string& encoding) {
  channels_.push_back({static_cast<std::uint16_t>(channels_.size()), schema, topic, encoding, {}});
  sequences_.push_back(0);
  channel_counts_.push_back(0);
  std::string bytes;
  append_channel(bytes, channels_.back());
  emit(bytes);
  return channels_.back().id;
}

void McapWriter::write(std::uint16_t channel, TimeNs t_log_ns, std::string_view data) {
  t_log_ns = std::max<TimeNs>(t_log_ns, 0);
  if (!chunk_.empty() && t_log_ns - t_chunk_begin_ns_ >= options_.chunk_ns) end_chunk();
  if (chunk_.empty()) t_chunk_begin_ns_ = t_chunk_end_ns_ = t_log_ns;
  t_chunk_begin_ns_ = std::min(t_chunk_begin_ns_, t_log_ns);
  t_chunk_end_ns_ = std::max(t_chunk_end_ns_, t_log_ns);
  chunk_index_[channel].push_back({t_log_ns, chunk_.size()});
  append_record(chunk_, McapOp::Message, [&](McapFields& fields) {
    fields.u16(channel);
    fields.u32(sequences_[channel]++);
    fields.time(t_log_ns);
    fields.time(t_log_ns);
    chunk_.append(data);
  });
  if (chunk_.size() >= options_.chunk_bytes) end_chunk();
}

std::string McapWriter::compressed(std::string_view records) {
  std::string bytes(ZSTD_compressBound(records.size()), '\0');
  const std::size_t size = ZSTD_compressCCtx(compressor_->context, bytes.data(), bytes.size(), records.data(),
                                             records.size(), options_.compression_level);
  if (ZSTD_isError(size) != 0) throw Error(std::string("zstd: ") + ZSTD_getErrorName(size));
  bytes.resize(size);
  return bytes;
}

void McapWriter::end_chunk() {
  if (chunk_.empty()) return;
  const std::string packed = compressed(chunk_);
  ChunkIndex index{t_chunk_begin_ns_, t_chunk_end_ns_, offset_, 0, 0, packed.size(), chunk_.size(), {}};
  std::string bytes;
  append_record(bytes, McapOp::Chunk, [&](McapFields& fields) {
    fields.time(t_chunk_begin_ns_);
    fields.time(t_chunk_end_ns_);
    fields.u64(chunk_.size());
    fields.u32(mcap_crc(chunk_));
    fields.text("zstd");
    fields.u64(packed.size());
    bytes.append(packed);
  });
  index.bytes = bytes.size();
  std::uint64_t count = 0;
  for (const auto& of_channel : chunk_index_) {
    index.index_offsets[of_channel.first] = offset_ + bytes.size();
    count += of_channel.second.size();
    append_record(bytes, McapOp::MessageIndex, [&](McapFields& fields) {
      fields.u16(of_channel.first);
      append_sized(fields, [&](McapFields& list) {
        for (const IndexEntry& entry : of_channel.second) {
          list.time(entry.t_log_ns);
          list.u64(entry.offset);
        }
      });
    });
  }
  index.index_bytes = bytes.size() - index.bytes;
  if (emit(bytes)) {
    t_begin_ns_ = messages_ == 0 ? t_chunk_begin_ns_ : std::min(t_begin_ns_, t_chunk_begin_ns_);
    t_end_ns_ = std::max(t_end_ns_, t_chunk_end_ns_);
    messages_ += count;
    for (const auto& [channel, entries] : chunk_index_) channel_counts_[channel] += entries.size();
    chunks_.push_back(std::move(index));
  } else {
    messages_lost_ += count;
  }
  chunk_.clear();
  chunk_index_.clear();
}

bool McapWriter::add_attachment(const std::string& name, const std::string& media_type, std::string_view data,
                                TimeNs t_log_ns) {
  end_chunk();
  std::string bytes;
  append_record(bytes, McapOp::Attachment, [&](McapFields& fields) {
    fields.time(t_log_ns);
    fields.time(t_log_ns);
    fields.text(name);
    fields.text(media_type);
    fields.u64(data.size());
    bytes.append(data);
    fields.u32(mcap_crc(std::string_view(bytes).substr(kMcapRecordHeadBytes)));
  });
  const AttachmentIndex index{offset_, bytes.size(), data.size(), t_log_ns, name, media_type};
  const bool kept = emit(bytes);
  if (kept) attachments_.push_back(index);
  attachments_lost_ += kept ? 0 : 1;
  return kept;
}

/// Everything between the end of the data and the footer, for a summary that begins at that offset.
std::string McapWriter::summary(std::uint64_t begin) const {
  struct Group {
    McapOp op;
    std::uint64_t begin, bytes;
  };
  std::string bytes;
  std::vector<Group> groups;
  const auto add_group = [&](McapOp op, const auto& items, const auto& append) {
    if (items.empty()) return;
    const std::size_t before = bytes.size();
    for (const auto& item : items) append(item);
    groups.push_back({op, begin + before, bytes.size() - before});
  };
  add_group(McapOp::Schema, schemas_, [&](const McapSchema& schema) { append_schema(bytes, schema); });
  add_group(McapOp::Channel, channels_, [&](const McapChannel& channel) { append_channel(bytes, channel); });
  add_group(McapOp::Statistics, std::vector<int>{1}, [&](int) {
    append_record(bytes, McapOp::Statistics, [&](McapFields& fields) {
      fields.u64(messages_);
      fields.u16(schemas_.size());
      fields.u32(channels_.size());
      fields.u32(attachments_.size());
      fields.u32(0);  // metadata records
      fields.u32(chunks_.size());
      fields.time(t_begin_ns_);
      fields.time(t_end_ns_);
      append_sized(fields, [&](McapFields& map) {
        for (std::size_t channel = 0; channel < channel_counts_.size(); ++channel) {
          map.u16(channel);
          map.u64(channel_counts_[channel]);
        }
      });
    });
  });
  add_group(McapOp::ChunkIndex, chunks_, [&](const ChunkIndex& chunk) {
    append_record(bytes, McapOp::ChunkIndex, [&](McapFields& fields) {
      fields.time(chunk.t_begin_ns);
      fields.time(chunk.t_end_ns);
      fields.u64(chunk.offset);
      fields.u64(chunk.bytes);
      append_sized(fields, [&](McapFields& map) {
        for (const auto& [channel, offset] : chunk.index_offsets) {
          map.u16(channel);
          map.u64(offset);
        }
      });
      fields.u64(chunk.index_bytes);
      fields.text("zstd");
      fields.u64(chunk.compressed_bytes);
      fields.u64(chunk.uncompressed_bytes);
    });
  });
  add_group(McapOp::AttachmentIndex, attachments_, [&](const AttachmentIndex& attachment) {
    append_record(bytes, McapOp::AttachmentIndex, [&](McapFields& fields) {
      fields.u64(attachment.offset);
      fields.u64(attachment.bytes);
      fields.time(attachment.t_log_ns);
      fields.time(attachment.t_log_ns);
      fields.u64(attachment.data_bytes);
      fields.text(attachment.name);
      fields.text(attachment.media_type);
    });
  });
  const std::uint64_t offsets_begin = begin + bytes.size();
  for (const Group& group : groups) {
    append_record(bytes, McapOp::SummaryOffset, [&](McapFields& fields) {
      fields.u8(static_cast<std::uint8_t>(group.op));
      fields.u64(group.begin);
      fields.u64(group.bytes);
    });
  }
  McapFields footer(bytes);
  footer.u8(static_cast<std::uint8_t>(McapOp::Footer));
  footer.u64(kFooterBytes);
  footer.u64(begin);
  footer.u64(offsets_begin);
  footer.u32(mcap_crc(bytes));  // of the summary and of the footer up to here
  return bytes;
}

void McapWriter::finish() {
  if (finished_) return;
  finished_ = true;
  end_chunk();
  std::string bytes;
  append_record(bytes, McapOp::DataEnd, [](McapFields& fields) { fields.u32(0); });  // 0: no checksum
  bytes += summary(offset_ + bytes.size()).append(kMcapMagic.data(), kMcapMagic.size());
  emit(bytes);
}

}  // namespace heel
