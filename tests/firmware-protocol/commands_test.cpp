// Commands to bytes and back, against byte strings known from other programs.
#include <gtest/gtest.h>

#include <limits>
#include <set>
#include <string>

#include "arcos/checksum.h"
#include "arcos/command_codec.h"
#include "firmware-protocol/hex.h"

namespace arcos {
namespace {

using test::Bytes;
using test::from_hex;
using test::to_hex;

struct Vector {
  const char* what;
  Frame frame;
  const char* bytes;
};

TEST(CommandVectors, ByteForByte) {
  const Vector vectors[] = {
      {"SYNC0", encode_plain(CommandId::Sync0), "fafb03000000"},
      {"SYNC1", encode_plain(CommandId::Sync1), "fafb03010001"},
      {"SYNC2", encode_plain(CommandId::Sync2), "fafb03020002"},
      {"OPEN 1", encode_integer(CommandId::Open, 1), "fafb06013b0100023b"},
      {"CONFIG 1", encode_integer(CommandId::Config, 1), "fafb06123b0100133b"},
      {"ENABLE 1", encode_integer(CommandId::Enable, 1), "fafb06043b0100053b"},
      {"VEL 250", encode_integer(CommandId::Vel, 250), "fafb060b3bfa00053b"},
      {"VEL -300", encode_integer(CommandId::Vel, -300), "fafb060b1b2c01371c"},
      {"RVEL -10", encode_integer(CommandId::RVel, -10), "fafb06151b0a001f1b"},
      {"VEL2 -100 200", encode_vel2(-100, 200), "fafb06201bf604161f"},
      {"STOP", encode_plain(CommandId::Stop), "fafb031d001d"},
      {"E_STOP", encode_plain(CommandId::EStop), "fafb03370037"},
      {"CLOSE", encode_plain(CommandId::Close), "fafb03020002"},
  };
  for (const Vector& vector : vectors) EXPECT_EQ(to_hex(vector.frame.bytes()), vector.bytes) << vector.what;
}

TEST(CommandVectors, ArgumentsThatAreNotIntegers) {
  // Worked by hand: 0f2b + 0219 + 3c ⇒ pairs 0f2b 0219, odd byte none; SAY "\x19\x3c".
  EXPECT_EQ(to_hex(encode_text(CommandId::Say, "\x19\x3c").bytes()), "fafb070f2b02193c1178");
  EXPECT_EQ(to_hex(encode_text(CommandId::Polling, "").bytes()), "fafb05032b00032b");
  EXPECT_EQ(to_hex(encode_digout(0x0f, 0x05).bytes()), "fafb061e3b050f234a");
}

TEST(Checksum, OddAndEvenBodies) {
  EXPECT_EQ(checksum(Bytes{}), 0x0000);
  EXPECT_EQ(checksum(Bytes{0x37}), 0x0037);
  EXPECT_EQ(checksum(Bytes{0x12, 0x34}), 0x1234);
  EXPECT_EQ(checksum(Bytes{0x12, 0x34, 0xff}), 0x12cb);                    // 0x34 ^ 0xff, not a sum
  EXPECT_EQ(checksum(Bytes{0xff, 0xff, 0x00, 0x02}), 0x0001);              // modulo 65536
  EXPECT_EQ(checksum(Bytes{0xff, 0xff, 0x00, 0x02, 0x01}), 0x0000);        // an odd byte after the wrap
  EXPECT_EQ(checksum(Bytes{0xff, 0xff, 0xff, 0xff, 0xff, 0xff}), 0xfffd);  // two wraps
}

TEST(CommandTable, EveryIdOnceWithNameAndMeaning) {
  std::set<std::uint8_t> ids;
  std::set<std::string> names;
  ASSERT_GT(command_table().size(), 30u);
  for (const CommandInfo& info : command_table()) {
    EXPECT_TRUE(ids.insert(static_cast<std::uint8_t>(info.id)).second) << info.name;
    EXPECT_TRUE(names.insert(info.name).second) << info.name;
    EXPECT_GT(std::string(info.meaning).size(), 4u) << info.name;
    EXPECT_EQ(find_command(info.id), &info);
  }
  for (int id = 0; id < 256; ++id) {
    const bool listed = ids.count(static_cast<std::uint8_t>(id)) != 0;
    EXPECT_EQ(find_command(static_cast<std::uint8_t>(id)) != nullptr, listed) << id;
  }
}

TEST(CommandEncoding, RefusesWhatTheTableForbids) {
  EXPECT_TRUE(encode_plain(CommandId::Reset).empty());
  EXPECT_TRUE(encode_plain(CommandId::Maintenance).empty());
  EXPECT_TRUE(encode_integer(CommandId::Reset, 1).empty());
  EXPECT_TRUE(encode_plain(CommandId::Vel).empty());              // needs its argument
  EXPECT_TRUE(encode_integer(CommandId::Stop, 1).empty());        // has none
  EXPECT_TRUE(encode_integer(CommandId::SetV, -1).empty());       // cannot be negative
  EXPECT_TRUE(encode_integer(CommandId::Polling, 1).empty());     // is a string
  EXPECT_TRUE(encode_text(CommandId::Vel, "250").empty());        // is an integer
  EXPECT_TRUE(encode_plain(static_cast<CommandId>(99)).empty());  // not in the table
}

TEST(CommandEncoding, SendsAtMost200) {
  // id, 2B, length and checksum take five of the count.
  EXPECT_EQ(encode_text(CommandId::Tty2, std::string(195, 'x')).bytes()[2], 200);
  EXPECT_TRUE(encode_text(CommandId::Tty2, std::string(196, 'x')).empty());
}

TEST(CommandRoundTrip, EveryIntegerComesBack) {
  for (int value = -32768; value <= 32767; ++value) {
    const Frame frame = encode_integer(CommandId::Vel, static_cast<std::int16_t>(value));
    Command command;
    ASSERT_EQ(decode_command(frame.body(), command), DecodeResult::Ok);
    ASSERT_TRUE(command.is(CommandId::Vel) && command.has_integer());
    ASSERT_EQ(command.value, value);
    ASSERT_EQ(command.type, value < 0 ? ArgumentType::Negative : ArgumentType::Positive);
    ASSERT_EQ(command.trailing_bytes, 0u);
  }
}

TEST(CommandRoundTrip, Vel2KeepsBothWheelsInTheirBytes) {
  for (int left = -2400; left <= 2400; left += 20) {
    for (int right = -2400; right <= 2400; right += 20) {
      Command command;
      ASSERT_EQ(decode_command(encode_vel2(left, right).body(), command), DecodeResult::Ok);
      const WheelSpeeds speeds = wheel_speeds_of_vel2(command);
      ASSERT_EQ(speeds.left_mm_s, left);
      ASSERT_EQ(speeds.right_mm_s, right);
    }
  }
}

TEST(CommandRoundTrip, Vel2RoundsAndClampsWithoutWrapping) {
  const auto sent = [](int left, int right) {
    Command command;
    EXPECT_EQ(decode_command(encode_vel2(left, right).body(), command), DecodeResult::Ok);
    return wheel_speeds_of_vel2(command);
  };
  EXPECT_EQ(sent(109, -109).left_mm_s, 100);
  EXPECT_EQ(sent(111, -111).right_mm_s, -120);
  constexpr int kHuge = std::numeric_limits<int>::max();
  EXPECT_EQ(sent(2560, -2560).left_mm_s, 2400);  // 128 steps would wrap to −128
  EXPECT_EQ(sent(kHuge, -kHuge).left_mm_s, 2400);
  EXPECT_EQ(sent(kHuge, -kHuge).right_mm_s, -2400);
}

TEST(CommandDecoding, Vel2AsAPositiveWord) {
  Command command;
  ASSERT_EQ(decode_command(from_hex("203b0afb"), command), DecodeResult::Ok);
  EXPECT_EQ(wheel_speeds_of_vel2(command).left_mm_s, -100);
  EXPECT_EQ(wheel_speeds_of_vel2(command).right_mm_s, 200);
}

TEST(CommandDecoding, TextPointsIntoThePacket) {
  const Bytes body = from_hex("2a2b03313233");
  Command command;
  ASSERT_EQ(decode_command(body, command), DecodeResult::Ok);
  EXPECT_EQ(command.type, ArgumentType::Text);
  EXPECT_EQ(to_hex(command.text), "313233");
}

TEST(CommandDecoding, OtherFormsThatClientsSend) {
  Command command;
  EXPECT_EQ(decode_command(from_hex("01"), command), DecodeResult::Ok);  // OPEN without argument
  EXPECT_FALSE(command.has_integer());
  EXPECT_EQ(decode_command(from_hex("073b"), command), DecodeResult::Ok);  // SETO as p2os sends it
  EXPECT_FALSE(command.has_integer());
  EXPECT_EQ(decode_command(from_hex("043b0100ff"), command), DecodeResult::Ok);
  EXPECT_EQ(command.value, 1);
  EXPECT_EQ(command.trailing_bytes, 1u);
  EXPECT_EQ(decode_command(from_hex("63"), command),
            DecodeResult::Ok);  // not in the table: the caller decides
  EXPECT_EQ(command.id, 0x63);
}

TEST(CommandDecoding, NamesTheError) {
  Command command;
  EXPECT_EQ(decode_command(Bytes{}, command), DecodeResult::Truncated);
  EXPECT_EQ(decode_command(from_hex("0b3bfa"), command), DecodeResult::Truncated);
  EXPECT_EQ(decode_command(from_hex("0b3cfa00"), command), DecodeResult::BadArgumentType);
  EXPECT_EQ(decode_command(from_hex("0b00"), command), DecodeResult::BadArgumentType);
  EXPECT_EQ(decode_command(from_hex("2a2b"), command), DecodeResult::Truncated);
  EXPECT_EQ(decode_command(from_hex("2a2b0331"), command), DecodeResult::Truncated);
}

}  // namespace
}  // namespace arcos
