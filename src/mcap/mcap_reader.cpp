#include "mcap/mcap_reader.h"

#include <fmt/format.h>
#include <zstd.h>

#include <algorithm>
#include <utility>

#include "heel/error.h"

namespace heel {
namespace {

constexpr std::uint64_t kMaxChunkBytes = 1 << 28;  // uncompressed
constexpr std::size_t kMaxProblems = 20;

}  // namespace

struct McapReader::Decompressor {
  ZSTD_DCtx* context = ZSTD_createDCtx();
  Decompressor() {
    if (context == nullptr) throw Error("zstd: no memory for a decompressor");
  }
  ~Decompressor() { ZSTD_freeDCtx(context); }
  Decompressor(const Decompressor&) = delete;
  Decompressor& operator=(const Decompressor&) = delete;
};

McapReader::McapReader(std::istream& file, std::string name)
    : file_(file), name_(std::move(name)), decompressor_(std::make_unique<Decompressor>()) {
  std::array<char, kMcapMagic.size()> magic{};
  file_.read(magic.data(), magic.size());
  if (!file_ || magic != kMcapMagic)
    throw Error(name_ + ": not an MCAP file (expected a recording of heeld or `heel simulate`)");
  offset_ = magic.size();
}

McapReader::~McapReader() = default;

void McapReader::complain(const std::string& what) {
  if (problems_.size() < kMaxProblems) {
    problems_.push_back(fmt::format("{}: byte {}: {}", name_, offset_, what));
  } else if (problems_.size() == kMaxProblems) {
    problems_.push_back(name_ + ": further damage is not listed");
  }
}

/// The file ends here, before its end.
bool McapReader::cut_off(const std::string& what) {
  ended_ = true;
  complain(fmt::format("{}; {} messages before it were read", what, messages_));
  return false;
}

/// The next record of the file, outside of chunks. False: there is none.
bool McapReader::read_record() {
  if (ended_) return false;
  std::array<char, kMcapRecordHeadBytes> head{};
  file_.read(head.data(), head.size());
  if (file_.gcount() == 0) return cut_off("the file has no end (the program or the power was cut off)");
  if (!file_) return cut_off("the file ends within a record (the program or the power was cut off)");
  McapFieldReader fields({head.data(), head.size()});
  op_ = static_cast<McapOp>(fields.u8());
  const std::uint64_t length = fields.u64();
  if (static_cast<std::uint8_t>(op_) == 0 || length > kMaxRecordBytes)
    return cut_off(
        fmt::format("not a record: kind {}, {} bytes (the file is damaged)", static_cast<int>(op_), length));
  // In pieces: a damaged length must not cost more memory than the file has bytes.
  body_.clear();
  constexpr std::uint64_t kPiece = 1 << 20;
  while (body_.size() < length) {
    const std::size_t before = body_.size();
    body_.resize(before + std::min(kPiece, length - before));
    file_.read(body_.data() + before, static_cast<std::streamsize>(body_.size() - before));
    if (!file_) return cut_off("the file ends within a record (the program or the power was cut off)");
  }
  return true;
}

bool McapReader::next(McapMessage& message) {
  for (;;) {
    if (next_in_chunk(message)) return true;
    if (!read_record()) return false;
    switch (op_) {
      case McapOp::Schema:
        take_schema(body_);
        break;
      case McapOp::Channel:
        take_channel(body_);
        break;
      case McapOp::Attachment:
        take_attachment(body_);
        break;
      case McapOp::Chunk:
        read_chunk(body_);
        break;
      case McapOp::Message:
        if (!take_message(body_, message)) break;
        offset_ += kMcapRecordHeadBytes + body_.size();
        return true;
      case McapOp::DataEnd:  // what follows repeats what was read
        ended_ = complete_ = true;
        break;
      default:
        break;
    }
    offset_ += kMcapRecordHeadBytes + body_.size();
  }
}

bool McapReader::next_in_chunk(McapMessage& message) {
  while (next_ < chunk_.size()) {
    McapFieldReader fields(std::string_view(chunk_).substr(next_));
    const auto op = static_cast<McapOp>(fields.u8());
    const std::uint64_t length = fields.u64();
    const std::string_view body = fields.take(length);
    if (!fields.ok()) {
      complain("the chunk before it holds a record that is longer than the chunk");
      break;
    }
    next_ += kMcapRecordHeadBytes + body.size();
    if (op == McapOp::Schema) take_schema(body);
    if (op == McapOp::Channel) take_channel(body);
    if (op == McapOp::Message && take_message(body, message)) return true;
  }
  chunk_.clear();
  next_ = 0;
  return false;
}

void McapReader::read_chunk(std::string_view body) {
  McapFieldReader fields(body);
  fields.time();
  fields.time();
  const std::uint64_t size = fields.u64();
  const std::uint32_t crc = fields.u32();
  const std::string_view compression = fields.text();
  const std::string_view records = fields.take(fields.u64());
  if (!fields.ok() || size > kMaxChunkBytes) return complain("a damaged chunk; it was left out");
  if (compression.empty()) {
    chunk_ = records;
  } else if (compression == "zstd") {
    // zstd's own head says the size, too: a damaged one must not cost memory.
    if (ZSTD_getFrameContentSize(records.data(), records.size()) != size)
      return complain("a chunk that does not unpack; it was left out");
    chunk_.resize(size);
    const std::size_t got = ZSTD_decompressDCtx(decompressor_->context, chunk_.data(), chunk_.size(),
                                                records.data(), records.size());
    if (ZSTD_isError(got) != 0 || got != size) {
      chunk_.clear();
      return complain("a chunk that does not unpack; it was left out");
    }
  } else {
    return complain(
        fmt::format("a chunk compressed with '{}' (expected zstd); it was left out", compression));
  }
  if (chunk_.size() == size && (crc == 0 || mcap_crc(chunk_) == crc)) return;
  chunk_.clear();
  complain("a chunk whose checksum is wrong (the file is damaged); it was left out");
}

void McapReader::take_schema(std::string_view body) {
  McapFieldReader fields(body);
  McapSchema schema;
  schema.id = fields.u16();
  schema.name = fields.text();
  schema.encoding = fields.text();
  schema.text = fields.text();
  if (!fields.ok()) return complain("a damaged schema; it was left out");
  schemas_[schema.id] = std::move(schema);
}

void McapReader::take_channel(std::string_view body) {
  McapFieldReader fields(body);
  McapChannel channel;
  channel.id = fields.u16();
  channel.schema = fields.u16();
  channel.topic = fields.text();
  channel.encoding = fields.text();
  McapFieldReader map(fields.text());
  while (map.ok() && !map.at_end()) {
    const std::string key(map.text());
    channel.metadata[key] = map.text();
  }
  if (!fields.ok() || !map.ok()) return complain("a damaged channel; it was left out");
  channels_[channel.id] = std::move(channel);
}

void McapReader::take_attachment(std::string_view body) {
  McapFieldReader fields(body);
  fields.time();
  fields.time();
  McapAttachment attachment;
  attachment.name = fields.text();
  attachment.media_type = fields.text();
  attachment.data = fields.take(fields.u64());
  const std::uint32_t crc = fields.u32();
  if (!fields.ok()) return complain("a damaged attachment; it was left out");
  if (crc != 0 && mcap_crc(body.substr(0, body.size() - sizeof crc)) != crc)
    return complain(fmt::format(
        "the attachment {}: its checksum is wrong (the file is damaged); it was left out", attachment.name));
  const std::string name = attachment.name;
  attachments_[name] = std::move(attachment);
}

bool McapReader::take_message(std::string_view body, McapMessage& message) {
  McapFieldReader fields(body);
  message.channel = fields.u16();
  message.sequence = fields.u32();
  message.t_log_ns = fields.time();
  message.t_publish_ns = fields.time();
  message.data = fields.rest();
  if (!fields.ok() || !channels_.contains(message.channel)) {
    complain("a damaged message, or one of an unknown channel; it was left out");
    return false;
  }
  ++messages_;
  return true;
}

const McapChannel& McapReader::channel(std::uint16_t id) const {
  const auto found = channels_.find(id);
  if (found == channels_.end()) throw Error(fmt::format("{}: no channel {}", name_, id));
  return found->second;
}

const McapSchema* McapReader::schema(std::uint16_t id) const {
  const auto found = schemas_.find(id);
  return found == schemas_.end() ? nullptr : &found->second;
}

}  // namespace heel
