// Any packets and any bytes, at any time, into a session. In addition to the sanitizers' checks, whatever the
// robot sends:
//   * a motion that is not zero is sent only in Running, with the motors on and no stop button pressed;
//   * it is never faster than the limits;
//   * RESET and MAINTENANCE are never sent.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "arcos/command_codec.h"
#include "arcos/parser.h"
#include "fuzz/require.h"
#include "robot/arcos_session.h"

namespace {

using namespace heel;
using heel::test::require;

void check_output(const ArcosSession& session, std::span<const std::uint8_t> bytes,
                  const RobotConfig& config) {
  arcos::Parser parser;
  parser.feed(bytes, 0, [&](const arcos::Packet& packet) {
    arcos::Command command;
    require(arcos::decode_command(packet.body, command) == arcos::DecodeResult::Ok);
    require(!command.is(arcos::CommandId::Reset) && !command.is(arcos::CommandId::Maintenance));
    const bool vel = command.is(arcos::CommandId::Vel);
    const bool rvel = command.is(arcos::CommandId::RVel);
    if ((!vel && !rvel) || command.value == 0) return;
    const RobotState& state = session.state();
    require(state.phase == LinkPhase::Running && state.motors_enabled && !state.stop_button &&
            !state.e_stall);
    require(std::abs(command.value) <= (vel ? config.v_limit_mm_s : config.yaw_rate_limit_deg_s));
  });
  require(parser.counters().bytes_discarded == 0 && parser.pending_bytes() == 0);
}

void tick(ArcosSession& session, const VelocityCommand& command, TimeNs now_ns, const RobotConfig& config) {
  session.advance(now_ns);
  check_output(session, session.send(command, now_ns), config);
}

/// A complete handshake until the motors are enabled: the fuzzer would not find it.
void connect(ArcosSession& session, TimeNs& now_ns, const RobotConfig& config) {
  arcos::Sip sip;
  sip.flags = arcos::kFlagMotorsEnabled;
  // A robot that heeld does not know would not be driven.
  const arcos::RobotIdentity robot{arcos::Text("robot"), arcos::Text("Pioneer"), arcos::Text("p3at-sh")};
  const arcos::Frame said[] = {arcos::encode_plain(arcos::CommandId::Sync0),
                               arcos::encode_plain(arcos::CommandId::Sync1),
                               arcos::encode_sync2_echo(robot),
                               arcos::encode_sip(sip),
                               arcos::encode_config({}),
                               arcos::encode_sip(sip)};
  for (const arcos::Frame& frame : said) {
    for (int i = 0; i < 16; ++i) {  // 0.32 s: longer than it listens, shorter than its time-out
      now_ns += 20 * kNsPerMs;
      tick(session, {}, now_ns, config);
    }
    session.receive(frame.bytes(), now_ns);
  }
  require(session.state().phase == LinkPhase::Running);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  RobotConfig config;
  config.address = "serial:/dev/ttyS0@9600";
  config.sync_retry_s = 1.0;
  config.config_wait_s = 0.2;
  ArcosSession session(config);
  TimeNs now_ns = kNsPerS;
  session.line_opened(now_ns);

  if (size % 4 != 0) connect(session, now_ns, config);

  // Each step: what to do, how many bytes it takes, the bytes.
  std::span<const std::uint8_t> rest(data, size);
  while (rest.size() >= 2) {
    const unsigned what = rest[0] % 16;
    const std::size_t count = std::min<std::size_t>(rest[1], rest.size() - 2);
    const auto bytes = rest.subspan(2, count);
    rest = rest.subspan(2 + count);
    if (what < 3) {
      session.receive(bytes, now_ns);
    } else if (what < 10) {
      session.receive(arcos::frame_body(bytes).bytes(), now_ns);
    } else if (what == 10) {
      session.line_lost(now_ns);
    } else if (what == 11) {
      session.line_opened(now_ns);
    } else if (what == 12) {
      session = ArcosSession(config);  // heeld starts again
      session.line_opened(now_ns);
    } else if (what == 13) {
      check_output(session, session.close(now_ns), config);
    } else {
      for (std::size_t i = 0; i < 1 + count; ++i) {  // time passes
        now_ns += 20 * kNsPerMs;
        tick(session, {now_ns, now_ns, 10.0, -10.0, 0}, now_ns, config);
      }
    }
    now_ns += 20 * kNsPerMs;
    tick(session, {now_ns, now_ns, 10.0, -10.0, 0}, now_ns, config);
  }
  return 0;
}
