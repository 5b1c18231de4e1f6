#include "sim/robot/virtual_client.h"

#include <algorithm>

namespace heel::test {

std::vector<std::uint8_t> from_hex(const std::string& hex) {
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2) {
    bytes.push_back(static_cast<std::uint8_t>(std::stoi(hex.substr(i, 2), nullptr, 16)));
  }
  return bytes;
}

sim::P3AtSettings exact_settings() {
  sim::P3AtSettings settings;
  settings.chassis = sim::exact_chassis();
  return settings;
}

sim::P3AtSettings fast_exact_settings() {
  sim::P3AtSettings settings = exact_settings();
  settings.boot_baud = 115200;
  return settings;
}

void VirtualClient::run_ms(int ms) {
  for (int i = 0; i < ms; ++i) {
    t_ns += kNsPerMs;
    robot.advance(t_ns);
    const std::vector<std::uint8_t> bytes = robot.take_output();
    raw.insert(raw.end(), bytes.begin(), bytes.end());
    parser_.feed(bytes, t_ns, [this](const arcos::Packet& packet) {
      packets.push_back({t_ns, {packet.body.begin(), packet.body.end()}});
    });
  }
}

void VirtualClient::run_fed_ms(int ms) {
  for (int done = 0; done < ms; done += 1000) {
    command(arcos::CommandId::Pulse);
    run_ms(std::min(1000, ms - done));
  }
}

void VirtualClient::sync() {
  for (const char* hex : {"fafb03000000", "fafb03010001", "fafb03020002"}) {
    const std::size_t before = packets.size();
    send_hex(hex);
    run_ms(60);
    ASSERT_GT(packets.size(), before) << "no echo of " << hex;
    EXPECT_EQ(packets.back().id(), from_hex(hex)[3]);
  }
}

void VirtualClient::open() {
  ASSERT_NO_FATAL_FAILURE(sync());
  command(arcos::CommandId::Open, 1);
  run_ms(20);
}

void VirtualClient::open_and_enable() {
  ASSERT_NO_FATAL_FAILURE(open());
  command(arcos::CommandId::Enable, 1);
  run_ms(20);
}

std::vector<Received> VirtualClient::of_id(std::uint8_t id) const {
  std::vector<Received> found;
  for (const Received& packet : packets) {
    if (packet.id() == id) found.push_back(packet);
  }
  return found;
}

std::vector<Received> VirtualClient::sips() const {
  std::vector<Received> found;
  for (const Received& packet : packets) {
    if (arcos::is_sip(packet.id())) found.push_back(packet);
  }
  return found;
}

arcos::Sip VirtualClient::last_sip() const {
  const std::vector<Received> all = sips();
  arcos::Sip sip;
  EXPECT_FALSE(all.empty()) << "no SIP";
  if (!all.empty()) {
    EXPECT_EQ(arcos::decode_sip(all.back().body, sip), arcos::DecodeResult::Ok);
  }
  return sip;
}

void VirtualClient::collect_events() {
  for (const sim::RobotEvent& event : robot.take_events()) events_.push_back(event);
}

bool VirtualClient::happened(sim::RobotEventKind kind) {
  return time_of(kind) >= 0;
}

TimeNs VirtualClient::time_of(sim::RobotEventKind kind) {
  collect_events();
  const auto found = std::find_if(events_.begin(), events_.end(),
                                  [kind](const sim::RobotEvent& event) { return event.kind == kind; });
  return found == events_.end() ? -1 : found->t_ns;
}

}  // namespace heel::test
