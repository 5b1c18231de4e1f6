#include "recording/private_wire.h"

#include <algorithm>
#include <set>

#include "arcos/checksum.h"
#include "arcos/commands.h"
#include "arcos/config_packet.h"
#include "arcos/packet.h"
#include "heel/error.h"
#include "heel/flow.h"
#include "recording/flow_json.h"

namespace heel {
namespace {

constexpr auto kSync2Id = static_cast<std::uint8_t>(arcos::CommandId::Sync2);
constexpr std::size_t kBytesFromSerialToName = 11;  // of CONFIGpac

/// Walks over the texts of a body, each with a NUL behind it.
struct WireTexts {
  std::span<std::uint8_t> body;
  std::size_t at = 1;  // behind the id

  void skip_text() {
    while (at < body.size() && body[at] != 0) ++at;
    ++at;
  }
  void blank_text() {
    for (; at < body.size() && body[at] != 0; ++at) body[at] = '-';
    ++at;
  }
};

}  // namespace

void PrivateWire::add(std::string_view json) {
  Piece piece{rest_begin_ + rest_.size()};
  try {
    std::set<std::string> other_version;
    const auto bytes = flow_from_json<WireBytes>(json, other_version);
    if (!bytes.to_robot) {
      piece.count = static_cast<std::uint8_t>(std::min<std::size_t>(bytes.count, bytes.bytes.size()));
      rest_.insert(rest_.end(), bytes.bytes.begin(), bytes.bytes.begin() + piece.count);
    }
  } catch (const Error&) {
    piece.readable = false;
  }
  pieces_.push_back(piece);
  search(/*at_end=*/false);
}

void PrivateWire::finish() {
  search(/*at_end=*/true);
}

void PrivateWire::search(bool at_end) {
  std::size_t at = 0;
  const auto has = [&](std::size_t bytes) { return rest_.size() - at >= bytes; };
  while (has(1)) {
    if (rest_[at] != arcos::kHeader0 || (has(2) && rest_[at + 1] != arcos::kHeader1)) {
      ++at;
      continue;
    }
    const std::size_t count = has(arcos::kHeaderSize) ? rest_[at + 2] : arcos::kMaxCount;
    if (count < arcos::kMinCount || count > arcos::kMaxCount) {
      ++at;
      continue;
    }
    const std::size_t size = arcos::kHeaderSize + count;
    if (!has(size) && !at_end) break;
    const std::size_t there = std::min(size, rest_.size() - at);
    rest_begin_ += at;
    rest_.erase(rest_.begin(), rest_.begin() + static_cast<std::ptrdiff_t>(at));
    at = take_packet({rest_.data(), there}, there == size) ? there : 1;
  }
  rest_begin_ += at;
  rest_.erase(rest_.begin(), rest_.begin() + static_cast<std::ptrdiff_t>(at));
}

/// False: its checksum is wrong, or it has no end. It may be a CONFIGpac even so: on some robots that never
/// passes its checksum.
bool PrivateWire::take_packet(std::span<const std::uint8_t> packet, bool whole) {
  if (packet.size() <= arcos::kHeaderSize) return false;
  const std::size_t end = packet.size() - (whole ? arcos::kChecksumSize : 0);
  const std::span<const std::uint8_t> body = packet.subspan(arcos::kHeaderSize, end - arcos::kHeaderSize);
  const bool right = whole && arcos::checksum(body) == (packet[end] << 8 | packet[end + 1]);
  std::vector<std::uint8_t> blanked(packet.begin(), packet.end());
  WireTexts texts{std::span(blanked).subspan(arcos::kHeaderSize, body.size())};
  if (body[0] == arcos::kConfigPacketId) {
    texts.skip_text();  // type
    texts.skip_text();  // subtype
    texts.blank_text();
    texts.at += kBytesFromSerialToName;
    texts.blank_text();
  } else if (body[0] == kSync2Id && right) {
    texts.blank_text();
  }
  if (right) {
    const std::uint16_t sum = arcos::checksum(texts.body);
    blanked[end] = static_cast<std::uint8_t>(sum >> 8);
    blanked[end + 1] = static_cast<std::uint8_t>(sum);
  }
  for (std::size_t i = 0; i < packet.size(); ++i)
    if (blanked[i] != packet[i]) instead_[rest_begin_ + i] = blanked[i];
  return right;
}

std::optional<std::string> PrivateWire::without_names(std::size_t message, std::string_view json) const {
  const Piece piece = message < pieces_.size() ? pieces_[message] : Piece{.readable = false};
  if (!piece.readable) return std::nullopt;
  const auto first = instead_.lower_bound(piece.begin);
  const auto last = instead_.lower_bound(piece.begin + piece.count);
  if (first == last) return std::string(json);
  std::set<std::string> other_version;
  auto bytes = flow_from_json<WireBytes>(json, other_version);
  for (auto one = first; one != last; ++one) bytes.bytes[one->first - piece.begin] = one->second;
  std::string changed;
  append_flow_json(changed, bytes);
  return changed;
}

}  // namespace heel
