// Any bytes into the parser and into every decoder. In addition to the sanitizers' checks:
//   * every byte is in a packet, discarded or pending;
//   * division of the bytes into other reads changes nothing;
//   * a decoded packet, encoded and decoded again, is the same.
#include <cstdint>
#include <span>
#include <vector>

#include "arcos/command_codec.h"
#include "arcos/config_packet.h"
#include "arcos/other_packets.h"
#include "arcos/parser.h"
#include "arcos/sip.h"
#include "fuzz/require.h"

namespace {

using arcos::DecodeResult;
using heel::test::require;
using Body = std::vector<std::uint8_t>;

template <typename Packet, typename Decode, typename Encode>
void round_trip(std::span<const std::uint8_t> body, Decode decode, Encode encode) {
  Packet packet;
  if (decode(body, packet) != DecodeResult::Ok) return;
  const arcos::Frame frame = encode(packet);
  if (frame.empty()) return;  // the fuzzer's body may be longer than a packet
  Packet again;
  require(decode(frame.body(), again) == DecodeResult::Ok);
  require(again == packet);
}

void decode_everything(std::span<const std::uint8_t> body) {
  round_trip<arcos::Sip>(body, arcos::decode_sip, arcos::encode_sip);
  round_trip<arcos::ConfigPacket>(body, arcos::decode_config, arcos::encode_config);
  round_trip<arcos::RobotIdentity>(body, arcos::decode_sync2_echo, arcos::encode_sync2_echo);
  round_trip<arcos::EncoderPacket>(body, arcos::decode_encoder, arcos::encode_encoder);
  round_trip<arcos::IoPacket>(body, arcos::decode_io, arcos::encode_io);
  arcos::Command command;
  if (arcos::decode_command(body, command) == DecodeResult::Ok) {
    require(command.text.size() + command.trailing_bytes <= body.size());
    arcos::wheel_speeds_of_vel2(command);
  }
}

std::vector<Body> parse(std::span<const std::uint8_t> bytes, std::size_t first_cut) {
  arcos::Parser parser;
  std::vector<Body> bodies;
  std::size_t in_packets = 0;
  const auto keep = [&](const arcos::Packet& packet) {
    require(!packet.body.empty() && packet.body.size() <= arcos::kMaxBodySize);
    bodies.emplace_back(packet.body.begin(), packet.body.end());
    in_packets += arcos::kHeaderSize + packet.body.size() + arcos::kChecksumSize;
  };
  parser.feed(bytes.first(first_cut), 1, keep);
  parser.feed(bytes.subspan(first_cut), 2, keep);
  require(in_packets + parser.counters().bytes_discarded + parser.pending_bytes() == bytes.size());
  require(parser.counters().packets == bodies.size());
  return bodies;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::uint8_t> bytes(data, size);
  const std::vector<Body> bodies = parse(bytes, 0);
  require(bodies == parse(bytes, size / 2));
  for (const Body& body : bodies) decode_everything(body);

  // Few random bytes have a right checksum: the decoders get them also as a body, and with a right frame.
  decode_everything(bytes);
  const arcos::Frame frame = arcos::frame_body(bytes);
  if (!frame.empty()) require(parse(frame.bytes(), 3) == std::vector<Body>{Body(bytes.begin(), bytes.end())});
  return 0;
}
