// A parser that keeps its packets, and byte streams to feed to it.
#pragma once

#include <cstdint>
#include <vector>

#include "arcos/parser.h"
#include "firmware-protocol/hex.h"

namespace arcos::test {

struct Seen {
  std::int64_t t_ns = 0;
  Bytes body;
  friend bool operator==(const Seen&, const Seen&) = default;
};

class Collector {
 public:
  void feed(std::span<const std::uint8_t> bytes, std::int64_t t_ns = 0) {
    parser_.feed(bytes, t_ns, [this](const Packet& packet) { keep(packet); });
  }
  void give_up_before(std::int64_t t_ns) {
    parser_.give_up_before(t_ns, [this](const Packet& packet) { keep(packet); });
  }
  std::vector<Bytes> bodies() const {
    std::vector<Bytes> all;
    for (const Seen& seen : seen_) all.push_back(seen.body);
    return all;
  }
  const std::vector<Seen>& seen() const { return seen_; }
  const ParserCounters& counters() const { return parser_.counters(); }
  Parser& parser() { return parser_; }

 private:
  void keep(const Packet& packet) {
    seen_.push_back({packet.t_first_byte_ns, Bytes(packet.body.begin(), packet.body.end())});
  }
  Parser parser_;
  std::vector<Seen> seen_;
};

inline Bytes framed(const Bytes& body) {
  const Frame frame = frame_body(body);
  return Bytes(frame.bytes().begin(), frame.bytes().end());
}

}  // namespace arcos::test
