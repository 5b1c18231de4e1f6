/// \file
/// Bytes in, packets out. All state is in the object, in fixed memory; reads may cut the bytes anywhere.
///
/// - Convention: a packet carries the time that the caller gave with its first byte.
/// - Units: nanoseconds of the caller's clock.
/// - Errors: counted in ParserCounters. When a candidate packet fails (impossible count, wrong checksum),
///   only its first header byte is given up and the search goes on with the next byte, so that a good packet
///   inside the span of a bad one is found.
/// - Source: MobileRobots Inc., "Pioneer 3 Operations Manual", 2006, chapter on ARCOS, packet protocols.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "arcos/packet.h"

namespace arcos {

/// A packet whose checksum is right. Borrowed: valid until the parser is next touched.
struct Packet {
  std::int64_t t_first_byte_ns = 0;  ///< the caller's stamp of the FA byte
  std::span<const std::uint8_t> body;

  std::uint8_t id() const { return body.front(); }  ///< a body is never empty
};

/// What was received since the parser was made.
struct ParserCounters {
  std::uint64_t packets = 0;
  std::uint64_t checksum_errors = 0;
  std::uint64_t length_errors = 0;    ///< FA FB followed by a count outside kMinCount…kMaxCount
  std::uint64_t bytes_discarded = 0;  ///< every byte that was not part of a packet
};

/// Finds packets in a stream of bytes.
class Parser {
 public:
  /// Takes bytes that arrived at `t_ns`; calls on_packet(const Packet&) for each packet that they complete.
  template <typename OnPacket>
  void feed(std::span<const std::uint8_t> bytes, std::int64_t t_ns, OnPacket&& on_packet) {
    for (const std::uint8_t byte : bytes) {
      push(byte, t_ns);
      drain(on_packet);
    }
  }

  /// Gives up the begun packet if its first byte came before `t_oldest_ns`. A false header with a large count
  /// would otherwise hold back the good packets behind it until that many bytes have come.
  template <typename OnPacket>
  void give_up_before(std::int64_t t_oldest_ns, OnPacket&& on_packet) {
    while (begin_ != end_ && t_ns_[begin_] < t_oldest_ns) {
      discard_one();
      drain(on_packet);
    }
  }

  /// Forgets begun packets (a new line); counters stay.
  void reset();

  const ParserCounters& counters() const { return counters_; }
  std::size_t pending_bytes() const { return end_ - begin_; }

 private:
  template <typename OnPacket>
  void drain(OnPacket&& on_packet) {
    Packet packet;
    while (take(packet)) on_packet(static_cast<const Packet&>(packet));
  }
  void push(std::uint8_t byte, std::int64_t t_ns);
  bool take(Packet& packet);
  void discard_one();

  // bytes_[begin_, end_) is not yet decided; after drain() it is shorter than one packet can be.
  std::array<std::uint8_t, kMaxPacketSize> bytes_{};
  std::array<std::int64_t, kMaxPacketSize> t_ns_{};
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  ParserCounters counters_;
};

}  // namespace arcos
