// The parser with damaged packets. The checksum is weak; these tests define exactly how weak:
//   * one wrong bit in body or checksum is always detected;
//   * two wrong bits in a body of whole pairs are not detected if, and only if, they have the same weight in
//     two pairs and opposite directions, or both are the pairs' top bits (2 · 2¹⁵ = 0 modulo 65536);
//   * exchanged pairs are not detected;
//   * a wrong count moves the checksum to other bytes, which may happen to match (zeros do).
#include <gtest/gtest.h>

#include <algorithm>

#include "arcos/command_codec.h"
#include "arcos/sip.h"
#include "firmware-protocol/collector.h"

namespace arcos {
namespace {

using test::Bytes;
using test::Collector;
using test::framed;
using test::from_hex;
using test::operator+;

Bytes flipped(Bytes bytes, std::size_t bit) {
  bytes[bit / 8] = static_cast<std::uint8_t>(bytes[bit / 8] ^ 1u << bit % 8);
  return bytes;
}

Bytes sip_body(bool odd) {
  Sip sip;
  sip.x_pos = 12345;
  sip.y_pos = 54321;
  sip.th_pos = -300;
  sip.left_mm_s = 250;
  sip.right_mm_s = 240;
  sip.battery_dv = 125;
  sip.flags = kFlagMotorsEnabled | kFlagPowerGood;
  sip.sonar_count = 2;
  sip.sonars[0] = {1, 1500};
  sip.sonars[1] = {9, 5000};
  if (odd) sip.gripper = 0x5A;
  const Frame frame = encode_sip(sip);
  return Bytes(frame.body().begin(), frame.body().end());
}

std::vector<Bytes> sample_bodies() {
  const Bytes vel = from_hex("0b1b2c01");
  return {sip_body(true), sip_body(false), vel, from_hex("1d"), from_hex("02414200434400454600")};
}

const Bytes kNext = from_hex("90 01020304 05060708");

TEST(ParserDamage, OneWrongBitIsNeverAcceptedAndTheNextPacketIs) {
  for (const Bytes& body : sample_bodies()) {
    const Bytes packet = framed(body);
    for (std::size_t bit = 0; bit < packet.size() * 8; ++bit) {
      Collector collector;
      // A count larger by 128 covers 128 more bytes: enough good packets follow.
      Bytes stream = flipped(packet, bit);
      for (int i = 0; i < 12; ++i) stream = stream + framed(kNext);
      collector.feed(stream);
      ASSERT_EQ(collector.bodies(), std::vector<Bytes>(12, kNext))
          << "bit " << bit << " of " << packet.size() * 8;
      ASSERT_EQ(collector.counters().bytes_discarded, packet.size()) << bit;
      const bool in_header = bit / 8 < kHeaderSize;  // then other errors than the checksum's are counted
      ASSERT_TRUE(in_header || collector.counters().checksum_errors == 1) << bit;
    }
  }
}

TEST(ParserDamage, TwoWrongBitsAreAcceptedExactlyWhenTheyCancel) {
  const Bytes body = sip_body(false);
  ASSERT_EQ(body.size() % 2, 0u);
  const Bytes packet = framed(body);
  const auto is_set = [&](std::size_t bit) { return (body[bit / 8] >> bit % 8 & 1) != 0; };
  const auto weight = [](std::size_t bit) {
    return bit % 8 + (bit / 8 % 2 == 0 ? 8 : 0);
  };  // high byte first
  int accepted = 0;
  for (std::size_t a = 0; a < body.size() * 8; ++a) {
    for (std::size_t b = a + 1; b < body.size() * 8; ++b) {
      Collector collector;
      collector.feed(flipped(flipped(packet, kHeaderSize * 8 + a), kHeaderSize * 8 + b));
      const bool cancel = weight(a) == weight(b) && (is_set(a) != is_set(b) || weight(a) == 15);
      ASSERT_EQ(collector.seen().size(), cancel ? 1u : 0u) << a << ' ' << b;
      accepted += cancel ? 1 : 0;
    }
  }
  EXPECT_GT(accepted, 0);  // such pairs of bits exist
}

TEST(ParserDamage, SwappedPairsAreAccepted) {
  Bytes body = from_hex("32 01 0203 0405");
  Bytes packet = framed(body);
  std::swap_ranges(packet.begin() + 5, packet.begin() + 7, packet.begin() + 7);
  Collector collector;
  collector.feed(packet);
  EXPECT_EQ(collector.bodies(), std::vector<Bytes>{from_hex("32 01 0405 0203")});
}

TEST(ParserDamage, AWrongCountOverZerosIsAccepted) {
  Bytes packet = framed(from_hex("0000000000"));
  ASSERT_EQ(packet[2], 7);
  packet[2] = 3;
  Collector collector;
  collector.feed(packet);
  EXPECT_EQ(collector.bodies(), std::vector<Bytes>{from_hex("00")});  // a SYNC0 that was never sent
}

TEST(ParserDamage, ATruncatedPacketLosesNoOther) {
  for (const Bytes& body : sample_bodies()) {
    const Bytes packet = framed(body);
    for (std::size_t kept = 0; kept < packet.size(); ++kept) {
      Collector collector;
      Bytes stream(packet.begin(), packet.begin() + static_cast<std::ptrdiff_t>(kept));
      for (int i = 0; i < 4; ++i) stream = stream + framed(kNext);
      collector.feed(stream);
      ASSERT_EQ(collector.bodies(), std::vector<Bytes>(4, kNext)) << kept;
      ASSERT_EQ(collector.counters().bytes_discarded, kept);
    }
  }
}

TEST(ParserDamage, AMissingByteLosesNoOtherPacket) {
  for (const Bytes& body : sample_bodies()) {
    const Bytes packet = framed(body);
    for (std::size_t missing = 0; missing < packet.size(); ++missing) {
      Bytes stream = packet;
      stream.erase(stream.begin() + static_cast<std::ptrdiff_t>(missing));
      for (int i = 0; i < 12; ++i) stream = stream + framed(kNext);
      Collector collector;
      collector.feed(stream);
      ASSERT_EQ(collector.bodies(), std::vector<Bytes>(12, kNext)) << missing;
    }
  }
}

TEST(ParserDamage, AGoodPacketInsideABadOneIsFound) {
  const Bytes inner = framed(kNext);
  Bytes outer = framed(from_hex("42 4242") + inner + from_hex("43"));
  outer.back() ^= 1;
  Collector collector;
  collector.feed(outer, 7);
  EXPECT_EQ(collector.bodies(), std::vector<Bytes>{kNext});
  EXPECT_EQ(collector.counters().bytes_discarded, outer.size() - inner.size());
}

TEST(ParserDamage, TheLongestBadPacketInAFullBuffer) {
  // Packets end at every position of the parser's buffer.
  Collector collector;
  std::size_t expected = 0;
  for (std::size_t size = 1; size < 60; ++size) {
    Bytes bad = framed(Bytes(kMaxBodySize, static_cast<std::uint8_t>(size)));
    bad.back() ^= 0x55;
    collector.feed(bad);
    collector.feed(framed(Bytes(size, 0x11)));
    expected += 1;
  }
  EXPECT_EQ(collector.seen().size(), expected);
  EXPECT_EQ(collector.counters().checksum_errors, 59u);
}

}  // namespace
}  // namespace arcos
