// The parser with good packets: divided anywhere, with garbage around, of every length, stamped at the first
// byte.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "arcos/command_codec.h"
#include "arcos/sip.h"
#include "firmware-protocol/collector.h"

namespace arcos {
namespace {

using test::Bytes;
using test::Collector;
using test::framed;
using test::from_hex;
using test::Seen;
using test::operator+;

const Bytes kOddBody = from_hex("32 01 02 03 fa");      // ends on a header byte
const Bytes kEvenBody = from_hex("90 fa fb 06 05 fa");  // holds what looks like a header
const Bytes kShortBody = from_hex("02");

TEST(ParserSplits, EveryPairOfCuts) {
  const Bytes first = framed(kOddBody), second = framed(kEvenBody), third = framed(kShortBody);
  const Bytes stream = first + second + third;
  const std::size_t starts[] = {0, first.size(), first.size() + second.size()};
  for (std::size_t a = 0; a <= stream.size(); ++a) {
    for (std::size_t b = a; b <= stream.size(); ++b) {
      Collector collector;
      collector.feed(std::span(stream).subspan(0, a), 1);
      collector.feed(std::span(stream).subspan(a, b - a), 2);
      collector.feed(std::span(stream).subspan(b), 3);
      const auto stamp = [&](std::size_t at) { return at < a ? 1 : at < b ? 2 : 3; };
      const std::vector<Seen> expected = {
          {stamp(starts[0]), kOddBody}, {stamp(starts[1]), kEvenBody}, {stamp(starts[2]), kShortBody}};
      ASSERT_EQ(collector.seen(), expected) << a << ' ' << b;
      ASSERT_EQ(collector.counters().bytes_discarded, 0u);
    }
  }
}

TEST(ParserLengths, EveryCount) {
  Collector collector;
  std::vector<Bytes> expected;
  for (std::size_t size = 1; size <= kMaxBodySize; ++size) {
    Bytes body(size);
    for (std::size_t i = 0; i < size; ++i) body[i] = static_cast<std::uint8_t>(size * 31 + i * 7);
    expected.push_back(body);
    collector.feed(framed(body));
  }
  EXPECT_EQ(collector.bodies(), expected);
  EXPECT_EQ(collector.counters().bytes_discarded, 0u);
}

TEST(ParserLengths, ImpossibleCounts) {
  const Bytes good = framed(kEvenBody);
  for (int count = 0; count < 256; ++count) {
    if (count >= static_cast<int>(kMinCount) && count <= static_cast<int>(kMaxCount)) continue;
    Collector collector;
    collector.feed(Bytes{0xFA, 0xFB, static_cast<std::uint8_t>(count)} + good);
    EXPECT_EQ(collector.bodies(), std::vector<Bytes>{kEvenBody}) << count;
    EXPECT_EQ(collector.counters().length_errors, 1u) << count;
    EXPECT_EQ(collector.counters().bytes_discarded, 3u) << count;
  }
}

struct Garbage {
  const char* what;
  const char* hex;
  unsigned length_errors;
};
// Garbage that cannot be the beginning of a packet is skipped at once.
const Garbage kGarbage[] = {
    {"nothing", "", 0},
    {"a radio modem's greeting", "574d53320d", 0},
    {"zeros", "00000000", 0},
    {"half a header", "fa00", 0},
    {"headers without end", "fafafafafa", 0},
    {"second header byte alone", "fbfb", 0},
    {"header with count 0", "fafb00", 1},
    {"header with count 2", "fafb02", 1},
    {"header with count 250", "fafbfa", 1},
    {"nested headers", "fafbfafb00", 2},
};

TEST(ParserGarbage, BeforeBetweenAndAfter) {
  for (const Garbage& garbage : kGarbage) {
    const Bytes junk = from_hex(garbage.hex);
    Collector collector;
    collector.feed(junk + framed(kOddBody) + junk + framed(kEvenBody) + junk + framed(kShortBody) + junk);
    const std::vector<Bytes> expected = {kOddBody, kEvenBody, kShortBody};
    EXPECT_EQ(collector.bodies(), expected) << garbage.what;
    EXPECT_EQ(collector.counters().bytes_discarded + collector.parser().pending_bytes(), 4 * junk.size())
        << garbage.what;
    EXPECT_EQ(collector.counters().length_errors, 4 * garbage.length_errors) << garbage.what;
    EXPECT_EQ(collector.counters().checksum_errors, 0u) << garbage.what;
  }
}

TEST(ParserWaiting, GivingUpAFalseHeaderReleasesThePacketAfterIt) {
  Collector collector;
  collector.feed(from_hex("fafbf9"), 100);  // 249 bytes are announced and do not come
  collector.feed(framed(kOddBody), 200);
  collector.feed(framed(kEvenBody), 300);
  EXPECT_TRUE(collector.seen().empty());
  collector.give_up_before(100);  // not older than that
  EXPECT_TRUE(collector.seen().empty());
  collector.give_up_before(101);
  const std::vector<Seen> expected = {{200, kOddBody}, {300, kEvenBody}};
  EXPECT_EQ(collector.seen(), expected);
  EXPECT_EQ(collector.counters().bytes_discarded, 3u);
}

TEST(ParserWaiting, ResetDiscardsAPartialPacketAndKeepsTheCounters) {
  const Bytes packet = framed(kEvenBody);
  Collector collector;
  collector.feed(packet);
  collector.feed(std::span(packet).first(5));
  collector.parser().reset();
  collector.feed(std::span(packet).subspan(5));
  EXPECT_EQ(collector.bodies().size(), 1u);
  collector.feed(packet);
  EXPECT_EQ(collector.bodies().size(), 2u);
  EXPECT_EQ(collector.counters().packets, 2u);
}

// The bytes of packets, the discarded and the pending bytes add up to the bytes fed.
RC_GTEST_PROP(ParserProperties, EveryByteIsCounted, ()) {
  // Bytes drawn so that headers and small counts are common.
  const auto byte =
      rc::gen::oneOf(rc::gen::arbitrary<std::uint8_t>(), rc::gen::element<std::uint8_t>(0xFA, 0xFB, 3, 4, 0));
  const auto stream = *rc::gen::container<Bytes>(byte);
  Collector collector;
  collector.feed(stream);
  std::size_t in_packets = 0;
  for (const Bytes& body : collector.bodies()) in_packets += kHeaderSize + body.size() + kChecksumSize;
  RC_ASSERT(in_packets + collector.counters().bytes_discarded + collector.parser().pending_bytes() ==
            stream.size());
}

// Fed byte by byte the parser gives the same packets as in one read.
RC_GTEST_PROP(ParserProperties, DivisionIntoReadsDoesNotMatter, (const Bytes& junk, const Bytes& tail)) {
  const Bytes stream = junk + framed(kOddBody) + tail + framed(kEvenBody) + junk;
  Collector whole, bytewise;
  whole.feed(stream);
  for (const std::uint8_t byte : stream) bytewise.feed(std::span(&byte, 1));
  RC_ASSERT(whole.seen() == bytewise.seen());
  RC_ASSERT(whole.counters().bytes_discarded == bytewise.counters().bytes_discarded);
}

}  // namespace
}  // namespace arcos
