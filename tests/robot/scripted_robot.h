// A small controller: it echoes the sync, sends SIPs and obeys ENABLE. A test changes its behaviour by its
// public fields. (src/sim/robot has the exact P3-AT.)
#pragma once

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <vector>

#include "arcos/command_codec.h"
#include "arcos/config_packet.h"
#include "arcos/other_packets.h"
#include "arcos/parser.h"
#include "arcos/sip.h"
#include "heel/time.h"
#include "robot/robot_address.h"

namespace heel::test {

using Bytes = std::vector<std::uint8_t>;

/// A command as the robot received it.
struct Received {
  TimeNs t_ns = 0;
  int id = 0;
  bool has_value = false;
  int value = 0;

  bool is(arcos::CommandId wanted) const { return id == static_cast<int>(wanted); }
  bool is(arcos::CommandId wanted, int with) const { return is(wanted) && has_value && value == with; }
};

class ScriptedRobot {
 public:
  // The script.
  int baud = 0;       ///< 0: understands every rate (pty, TCP)
  bool open = false;  ///< left open by an earlier session
  bool mute = false;  ///< hears, says nothing
  bool answers_config = true;
  bool config_damaged = false;
  int enables_to_ignore = 0;
  bool enable_ends_e_stall = false;  ///< otherwise an E-stall keeps the motors off
  int host_bauds_to_follow = 100;
  int rate_after_close = 0;  ///< 0: CLOSE leaves the rate as it is
  Bytes chatter;             ///< what it says all the time in place of ARCOS, with `chatters`
  bool chatters = false;
  int unheard_at = 0;              ///< a rate at which nothing it says arrives
  int last_echoes_to_swallow = 0;  ///< of SYNC2
  TimeNs sip_period_ns = 100 * kNsPerMs;
  std::string_view junk;  ///< sent before the first echo
  arcos::RobotIdentity identity{arcos::Text("rex"), arcos::Text("Pioneer"), arcos::Text("p3at-sh")};
  bool names_damaged = false;  ///< the echo of SYNC2 ends before the names
  arcos::Sip sip;              ///< what it says of itself
  arcos::ConfigPacket config;

  // What it received and sent.
  std::vector<Received> log;
  std::size_t bytes_received = 0;

  ScriptedRobot() {
    config.type = arcos::Text("Pioneer");
    config.subtype = arcos::Text("p3at-sh");
    config.watchdog_ms = 2000;
    config.front_bumps = config.rear_bumps = config.charger = config.sonar_cycle_ms = std::uint8_t{0};
    sip.battery_dv = 126;
  }

  void receive(std::span<const std::uint8_t> bytes, int at_baud, TimeNs now_ns) {
    bytes_received += bytes.size();
    if (baud != 0 && at_baud != baud) return;  // framing errors to a UART
    parser_.feed(bytes, now_ns, [&](const arcos::Packet& packet) {
      arcos::Command command;
      if (arcos::decode_command(packet.body, command) == arcos::DecodeResult::Ok) obey(command, now_ns);
    });
  }

  /// The bytes that it sends now. Call it often.
  Bytes speak(TimeNs now_ns) {
    if (open && now_ns - t_sip_ns_ >= sip_period_ns) {
      t_sip_ns_ = now_ns;
      say(arcos::encode_sip(sip));
    }
    Bytes said;
    said.swap(waiting_);
    if (chatters) return chatter;
    return mute || (baud != 0 && baud == unheard_at) ? Bytes{} : said;
  }

  void say(const arcos::Frame& frame) {
    waiting_.insert(waiting_.end(), frame.bytes().begin(), frame.bytes().end());
  }
  void set_flag(arcos::SipFlag flag, bool on) {
    sip.flags = static_cast<std::uint16_t>(on ? sip.flags | flag : sip.flags & ~flag);
  }

  std::vector<Received> received(arcos::CommandId id) const {
    std::vector<Received> all;
    for (const Received& one : log) {
      if (one.is(id)) all.push_back(one);
    }
    return all;
  }
  /// Index of the first such command at or after `from`; log.size() if there is none.
  std::size_t find(arcos::CommandId id, std::size_t from = 0) const {
    const auto begin = log.begin() + static_cast<std::ptrdiff_t>(std::min(from, log.size()));
    const auto at = std::find_if(begin, log.end(), [&](const Received& r) { return r.is(id); });
    return static_cast<std::size_t>(at - log.begin());
  }

 private:
  void obey(const arcos::Command& command, TimeNs now_ns) {
    using arcos::CommandId;
    log.push_back({now_ns, command.id, command.has_integer(), command.value});
    if (!open) return shake_hands(command);
    if (command.is(CommandId::Close)) {
      open = false;
      sync_ = 0;
      if (rate_after_close != 0) baud = rate_after_close;
    } else if (command.is(CommandId::Config) && answers_config) {
      arcos::Frame frame = arcos::encode_config(config);
      say(frame);
      if (config_damaged) waiting_.back() ^= 0x5A;
    } else if (command.is(CommandId::HostBaud)) {
      if (host_bauds_to_follow-- > 0) baud = kRobotBauds.at(static_cast<std::size_t>(command.value));
    } else if (command.is(CommandId::Enable)) {
      if (command.value == 1 && enables_to_ignore-- > 0) return;
      if (enable_ends_e_stall) set_flag(arcos::kFlagEStall, false);
      if ((sip.flags & arcos::kFlagEStall) != 0) return;
      set_flag(arcos::kFlagMotorsEnabled, command.value == 1);
    }
  }

  void shake_hands(const arcos::Command& command) {
    if (!junk.empty()) {
      waiting_.insert(waiting_.end(), junk.begin(), junk.end());
      junk = {};
    }
    if (sync_ == 3) {  // SYNC2 has been echoed: now 0, 1, 2 are PULSE, OPEN, CLOSE
      if (command.id == 1) open = true;
      if (command.id == 2) sync_ = 0;
    } else if (command.has_integer()) {
      return;  // a CLOSE without a session
    } else if (command.id == 0) {
      sync_ = 1;
      say(arcos::encode_plain(arcos::CommandId::Sync0));
    } else if (command.id == 1 && sync_ == 1) {
      sync_ = 2;
      say(arcos::encode_plain(arcos::CommandId::Sync1));
    } else if (command.id == 2 && sync_ == 2) {
      sync_ = 3;
      if (last_echoes_to_swallow-- > 0) return;
      say(names_damaged ? arcos::encode_plain(arcos::CommandId::Sync2) : arcos::encode_sync2_echo(identity));
    }
  }

  arcos::Parser parser_;
  Bytes waiting_;
  int sync_ = 0;
  TimeNs t_sip_ns_ = -kNsPerS;
};

}  // namespace heel::test
