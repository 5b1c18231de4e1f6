// SIP, CONFIGpac, ENCODER, IO and the sync echo: layouts written by hand, round trips, and every truncation.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "arcos/config_packet.h"
#include "arcos/other_packets.h"
#include "arcos/sip.h"
#include "firmware-protocol/hex.h"

namespace arcos {
namespace {

using test::Bytes;
using test::from_hex;
using test::to_hex;
using test::operator+;

// A moving robot, two sonar readings, the whole tail. No two fields have the same value.
const char* const kSipHead =
    "33"         // id
    "e803 fa00"  // x 1000, y 250
    "00fc"       // heading −1024
    "2c01 d4fe"  // left 300, right −300 mm/s
    "7b"         // 12.3 V
    "0584"       // left stall, rear segment 1; front segments 1 and 6
    "f6ff 4304"  // set point −10; motors, sonar 1, E-stall, power good
    "2d 02";     // compass 90°, two readings
const char* const kSipSonars = "03 1027 0f 8813";
const char* const kSipTail =
    "11 22 33 44 55"  // gripper … digital out
    "7c00 02"         // 12.4 V, overcharge
    "9cff 0080";      // −10.0 deg/s, fault bit 15

Sip full_sip() {
  Sip sip;
  sip.id = kSipMoving;
  sip.x_pos = 1000;
  sip.y_pos = 250;
  sip.th_pos = -1024;
  sip.left_mm_s = 300;
  sip.right_mm_s = -300;
  sip.battery_dv = 123;
  sip.stall_and_bumpers = 0x8405;
  sip.control = -10;
  sip.flags = 0x0443;
  sip.compass_2deg = 45;
  sip.sonar_count = 2;
  sip.sonars[0] = {3, 10000};
  sip.sonars[1] = {15, 5000};
  sip.gripper = 0x11;
  sip.ad_port = 0x22;
  sip.analog = 0x33;
  sip.digital_in = 0x44;
  sip.digital_out = 0x55;
  sip.battery_long_dv = 124;
  sip.charge_state = 2;
  sip.rotation_ddeg_s = -100;
  sip.fault_flags = 0x8000;
  return sip;
}

Bytes full_sip_body() {
  return from_hex(kSipHead) + from_hex(kSipSonars) + from_hex(kSipTail);
}

TEST(SipLayout, DecodesEveryField) {
  Sip sip;
  ASSERT_EQ(decode_sip(full_sip_body(), sip), DecodeResult::Ok);
  EXPECT_EQ(sip, full_sip());
}

TEST(SipLayout, EncodesEveryField) {
  EXPECT_EQ(to_hex(encode_sip(full_sip()).body()), to_hex(full_sip_body()));
}

TEST(SipLayout, StallAndBumperBits) {
  const Sip sip = full_sip();  // low byte 05, high byte 84
  EXPECT_TRUE(sip.stall_left());
  EXPECT_FALSE(sip.stall_right());
  EXPECT_EQ(sip.bumpers_rear(), 0b0000010);
  EXPECT_EQ(sip.bumpers_front(), 0b1000010);
  for (int bits = 0; bits < 0x10000; ++bits) {
    Sip any;
    any.stall_and_bumpers = static_cast<std::uint16_t>(bits);
    ASSERT_EQ(
        stall_and_bumpers_word(any.stall_left(), any.stall_right(), any.bumpers_front(), any.bumpers_rear()),
        any.stall_and_bumpers);
  }
}

/// Unsets the tail fields of which fewer than all bytes are among the first `tail_bytes`.
Sip sip_with_tail_of(std::size_t tail_bytes) {
  Sip sip = full_sip();
  if (tail_bytes < 1) sip.gripper.reset();
  if (tail_bytes < 2) sip.ad_port.reset();
  if (tail_bytes < 3) sip.analog.reset();
  if (tail_bytes < 4) sip.digital_in.reset();
  if (tail_bytes < 5) sip.digital_out.reset();
  if (tail_bytes < 7) sip.battery_long_dv.reset();
  if (tail_bytes < 8) sip.charge_state.reset();
  if (tail_bytes < 10) sip.rotation_ddeg_s.reset();
  if (tail_bytes < 12) sip.fault_flags.reset();
  return sip;
}

TEST(SipTruncation, EveryLengthOfTheTail) {
  const Bytes body = full_sip_body();
  const std::size_t without_tail = 20 + 3 * 2;
  for (std::size_t size = without_tail; size <= body.size(); ++size) {
    Sip sip;
    ASSERT_EQ(decode_sip(std::span(body).first(size), sip), DecodeResult::Ok) << size;
    EXPECT_EQ(sip, sip_with_tail_of(size - without_tail)) << size;
  }
}

TEST(SipTruncation, EveryLengthBeforeTheTailIsRefused) {
  const Bytes body = full_sip_body();
  for (std::size_t size = 0; size < 20 + 3 * 2; ++size) {
    Sip sip;
    EXPECT_EQ(decode_sip(std::span(body).first(size), sip), DecodeResult::Truncated) << size;
  }
}

TEST(SipTruncation, BytesAfterTheLastKnownFieldAreIgnored) {
  Sip sip;
  ASSERT_EQ(decode_sip(full_sip_body() + from_hex("deadbeef"), sip), DecodeResult::Ok);
  EXPECT_EQ(sip, full_sip());
}

TEST(SipTruncation, EncodingStopsAtTheFirstUnsetField) {
  Sip sip = full_sip();
  sip.charge_state.reset();  // the two after it are set, but would be read as other fields
  Sip back;
  ASSERT_EQ(decode_sip(encode_sip(sip).body(), back), DecodeResult::Ok);
  EXPECT_EQ(back, sip_with_tail_of(7));
}

TEST(SipIds, ThirtyToThirtyFourHex) {
  for (int id = 0; id < 256; ++id) {
    Bytes body = full_sip_body();
    body[0] = static_cast<std::uint8_t>(id);
    Sip sip;
    const auto expected = id >= 0x30 && id <= 0x34 ? DecodeResult::Ok : DecodeResult::WrongId;
    EXPECT_EQ(decode_sip(body, sip), expected) << id;
  }
}

TEST(SipSonars, AsManyAsThePacketHolds) {
  Sip sip;
  sip.sonar_count = static_cast<std::uint8_t>(kMaxSonarReadings);
  sip.sonars.back() = {74, 4999};
  Sip back;
  ASSERT_EQ(decode_sip(encode_sip(sip).body(), back), DecodeResult::Ok);
  EXPECT_EQ(back, sip);

  sip.sonar_count++;
  EXPECT_TRUE(encode_sip(sip).empty());
  Bytes body = full_sip_body();
  body[19] = 255;  // states more than any packet can hold
  EXPECT_EQ(decode_sip(body, back), DecodeResult::Truncated);
}

ConfigPacket full_config() {
  ConfigPacket c;
  c.type = Text("Pioneer");
  c.subtype = Text("p3at-sh");
  c.serial = Text("X1");
  c.four_motors = 1;
  c.rot_vel_top = 360;
  c.trans_vel_top = 1500;
  c.rot_acc_top = 600;
  c.trans_acc_top = 4000;
  c.pwm_max = 500;
  c.name = Text("rex");
  c.sip_cycle_ms = 100;
  c.host_baud = 2;
  c.aux1_baud = 3;
  c.gripper = 4;
  c.front_sonar = 5;
  c.rear_sonar = 6;
  c.low_battery_dv = 110;
  c.rev_count = 16570;
  c.watchdog_ms = 2000;
  c.p2_mpacs = 1;
  c.stall_val = 200;
  c.stall_count_ms = 100;
  c.joy_vel = 700;
  c.joy_rvel = 60;
  c.rot_vel_max = 100;
  c.trans_vel_max = 750;
  c.rot_acc = 101;
  c.rot_decel = 102;
  c.rot_kp = 40;
  c.rot_kv = 20;
  c.rot_ki = 9;
  c.trans_acc = 300;
  c.trans_decel = 301;
  c.trans_kp = 41;
  c.trans_kv = 31;
  c.trans_ki = 8;
  c.front_bumps = 5;
  c.rear_bumps = 7;
  c.charger = 0;
  c.sonar_cycle_ms = 40;
  c.autobaud = 2;
  c.has_gyro = 1;
  c.drift_factor = -3;
  c.aux2_baud = 1;
  c.aux3_baud = 2;
  c.ticks_mm = 138;
  c.shutdown_dv = 99;
  c.version = Text("2.6");
  c.gyro_cw = 11;
  c.gyro_ccw = 12;
  c.kinematics_delay = 13;
  return c;
}

// In the order of the ARCOS manual, one line for each of its lines.
const char* const kConfigHead =
    "20 50696f6e65657200 703361742d736800 583100 01 6801 dc05 5802 a00f f401 72657800 64 02 03"
    "0400 0500 06 6e00 ba40 d007 01 c800 6400 bc02 3c00 6400 ee02"
    "6500 6600 2800 1400 0900 2c01 2d01 2900 1f00 0800";
const char* const kConfigTail = "05 07 00 28 02 01 fdff 01 02 8a00 6300 322e3600 0b00 0c00 0d";

TEST(ConfigLayout, BothWays) {
  const Bytes body = from_hex(kConfigHead) + from_hex(kConfigTail);
  EXPECT_EQ(to_hex(encode_config(full_config()).body()), to_hex(body));
  ConfigPacket config;
  ASSERT_EQ(decode_config(body, config), DecodeResult::Ok);
  EXPECT_EQ(config, full_config());
  ASSERT_EQ(decode_config(body + from_hex("010203"), config), DecodeResult::Ok);  // later firmware
  EXPECT_EQ(config, full_config());
}

TEST(ConfigTruncation, EveryLength) {
  const Bytes head = from_hex(kConfigHead);
  const Bytes body = head + from_hex(kConfigTail);
  for (std::size_t size = 0; size < body.size(); ++size) {
    ConfigPacket config;
    const DecodeResult result = decode_config(std::span(body).first(size), config);
    ASSERT_EQ(result, size < head.size() ? DecodeResult::Truncated : DecodeResult::Ok) << size;
    if (result != DecodeResult::Ok) continue;
    // The complete fields are right, and encoding them again gives exactly their bytes.
    const Frame again = encode_config(config);
    ASSERT_LE(again.body().size(), size);
    EXPECT_TRUE(std::equal(again.body().begin(), again.body().end(), body.begin())) << size;
    EXPECT_EQ(config.front_bumps.has_value(), size >= head.size() + 1);
    EXPECT_EQ(config.drift_factor.has_value(), size >= head.size() + 8);
    EXPECT_EQ(config.version.has_value(), size >= head.size() + 18) << size;
    EXPECT_FALSE(config.kinematics_delay.has_value());
  }
}

TEST(ConfigText, TooLongIsNamed) {
  ConfigPacket config;
  Bytes body = from_hex("20") + Bytes(Text::kCapacity + 1, 'x') + from_hex("00") + Bytes(120, 0);
  EXPECT_EQ(decode_config(body, config), DecodeResult::TextTooLong);
  body.erase(body.begin() + 1);
  EXPECT_EQ(decode_config(body, config), DecodeResult::Ok);
  EXPECT_EQ(config.type.view(), std::string(Text::kCapacity, 'x'));
}

TEST(SyncEcho, ThreeStrings) {
  const Bytes body = from_hex("02 72657800 50696f6e65657200 703361742d736800");
  const RobotIdentity rex{Text("rex"), Text("Pioneer"), Text("p3at-sh")};
  EXPECT_EQ(to_hex(encode_sync2_echo(rex).body()), to_hex(body));
  RobotIdentity identity;
  ASSERT_EQ(decode_sync2_echo(body, identity), DecodeResult::Ok);
  EXPECT_EQ(identity, rex);
  for (std::size_t size = 0; size < body.size(); ++size) {
    EXPECT_EQ(decode_sync2_echo(std::span(body).first(size), identity), DecodeResult::Truncated) << size;
  }
  EXPECT_EQ(decode_sync2_echo(from_hex("01"), identity), DecodeResult::WrongId);
}

TEST(EncoderLayout, SignedThirtyTwoBits) {
  const Bytes body = from_hex("90 78563412 feffffff");
  EncoderPacket encoder;
  ASSERT_EQ(decode_encoder(body, encoder), DecodeResult::Ok);
  EXPECT_EQ(encoder.left_ticks, 0x12345678);
  EXPECT_EQ(encoder.right_ticks, -2);
  EXPECT_EQ(to_hex(encode_encoder(encoder).body()), to_hex(body));
  for (std::size_t size = 0; size < body.size(); ++size) {
    EXPECT_EQ(decode_encoder(std::span(body).first(size), encoder), DecodeResult::Truncated) << size;
  }
  EXPECT_EQ(decode_encoder(from_hex("91 0000000000000000"), encoder), DecodeResult::WrongId);
}

TEST(IoLayout, ThreeListsWithTheirLengths) {
  const Bytes body = from_hex("f0 02 0a0b 01 0c 03 0102 ff03 0000");
  IoPacket io;
  ASSERT_EQ(decode_io(body, io), DecodeResult::Ok);
  EXPECT_EQ(io.input_count, 2);
  EXPECT_EQ(io.inputs[1], 0x0b);
  EXPECT_EQ(io.output_count, 1);
  EXPECT_EQ(io.outputs[0], 0x0c);
  EXPECT_EQ(io.analog_count, 3);
  EXPECT_EQ(io.analogs[0], 0x0201);
  EXPECT_EQ(io.analogs[1], 1023);
  EXPECT_EQ(to_hex(encode_io(io).body()), to_hex(body));
  for (std::size_t size = 0; size < body.size(); ++size) {
    EXPECT_EQ(decode_io(std::span(body).first(size), io), DecodeResult::Truncated) << size;
  }
  EXPECT_EQ(decode_io(from_hex("f0 ff"), io), DecodeResult::Truncated);
  io.input_count = IoPacket::kMaxBytes + 1;
  EXPECT_TRUE(encode_io(io).empty());
}

TEST(Framing, LongestAndShortestBodies) {
  EXPECT_TRUE(frame_body(Bytes{}).empty());
  EXPECT_EQ(frame_body(Bytes{0x42}).size(), 6u);
  EXPECT_EQ(frame_body(Bytes(kMaxBodySize, 1)).bytes()[2], 249);
  EXPECT_TRUE(frame_body(Bytes(kMaxBodySize + 1, 1)).empty());
}

}  // namespace
}  // namespace arcos
