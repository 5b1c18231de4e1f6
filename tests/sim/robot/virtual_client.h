// A client in virtual time: sends bytes to a sim::P3At, lets time pass in millisecond steps, and keeps every
// packet that comes back with the moment it was complete.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <initializer_list>
#include <string>
#include <vector>

#include "arcos/command_codec.h"
#include "arcos/config_packet.h"
#include "arcos/parser.h"
#include "arcos/sip.h"
#include "sim/robot/p3at.h"

namespace heel::test {

/// "fafb03000000" → bytes.
std::vector<std::uint8_t> from_hex(const std::string& hex);

/// A robot without slip and drift: its true motion is its odometry.
sim::P3AtSettings exact_settings();
/// … and with a line at 115200 baud.
sim::P3AtSettings fast_exact_settings();

struct Received {
  TimeNs t_ns = 0;
  std::vector<std::uint8_t> body;
  std::uint8_t id() const { return body.front(); }
};

class VirtualClient {
 public:
  explicit VirtualClient(const sim::P3AtSettings& settings, std::uint64_t seed = 1) : robot(settings, seed) {}

  void send(std::span<const std::uint8_t> bytes) { robot.receive(bytes, t_ns); }
  void send_hex(const std::string& hex) { send(from_hex(hex)); }
  void send(const arcos::Frame& frame) { send(frame.bytes()); }
  void command(arcos::CommandId id) { send(arcos::encode_plain(id)); }
  void command(arcos::CommandId id, int value) {
    send(arcos::encode_integer(id, static_cast<std::int16_t>(value)));
  }

  /// Lets time pass; what comes back is added to `raw` and `packets`.
  void run_ms(int ms);
  /// Lets time pass with a PULSE every second, so that the watchdog stays away.
  void run_fed_ms(int ms);

  void sync();             ///< SYNC0…SYNC2; fails the test when an echo is missing
  void open();             ///< sync and OPEN
  void open_and_enable();  ///< … and motors on

  /// Packets with this id; SIPs: id 0x32 or 0x33.
  std::vector<Received> of_id(std::uint8_t id) const;
  std::vector<Received> sips() const;
  /// The newest SIP; fails the test when there is none.
  arcos::Sip last_sip() const;
  void forget() { raw.clear(), packets.clear(); }
  /// Whether an event of this kind has happened, among all so far.
  bool happened(sim::RobotEventKind kind);
  TimeNs time_of(sim::RobotEventKind kind);

  sim::P3At robot;
  TimeNs t_ns = 0;
  std::vector<std::uint8_t> raw;
  std::vector<Received> packets;

 private:
  void collect_events();

  arcos::Parser parser_;
  std::vector<sim::RobotEvent> events_;
};

}  // namespace heel::test
