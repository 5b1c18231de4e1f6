#include "golden/video/frame_commands.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "arcos/command_codec.h"
#include "arcos/parser.h"

namespace heel::test {
namespace {

std::vector<std::uint8_t> bytes_of(const std::string& hex) {
  std::vector<std::uint8_t> bytes(hex.size() / 2);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const char* two = hex.data() + 2 * i;
    if (std::from_chars(two, two + 2, bytes[i], 16).ptr != two + 2)
      throw std::runtime_error("not hex: " + hex);
  }
  return bytes;
}

/// Collects VEL and RVEL of one tick: RVEL follows its VEL.
class VelocityCollector {
 public:
  void take(const arcos::Packet& packet, double t_s) {
    arcos::Command command;
    if (arcos::decode_command(packet.body, command) != arcos::DecodeResult::Ok)
      throw std::runtime_error("a packet that is no command");
    // Before the session is open, ids 0…2 are sent alone: these are not velocities.
    if (command.is(arcos::CommandId::Vel)) vel_mm_s_ = command.value;
    if (command.is(arcos::CommandId::RVel))
      sent.push_back({t_s, {static_cast<double>(vel_mm_s_), static_cast<double>(command.value)}});
  }
  std::vector<SentVelocity> sent;

 private:
  std::int32_t vel_mm_s_ = 0;
};

}  // namespace

std::vector<SentVelocity> read_wire(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error(path + ": cannot read");
  arcos::Parser parser;
  VelocityCollector collector;
  double t_s = 0.0;
  for (std::string hex; file >> t_s >> hex;)
    parser.feed(bytes_of(hex), 0, [&](const arcos::Packet& packet) { collector.take(packet, t_s); });
  if (!file.eof()) throw std::runtime_error(path + ": a line that is not \"seconds hex\"");
  if (parser.counters().bytes_discarded > 0) throw std::runtime_error(path + ": bytes that are no packets");
  return collector.sent;
}

FrameClock::FrameClock(const std::string& poses_csv, int first_frame, int first_count) {
  std::ifstream file(poses_csv);
  std::string line;
  std::getline(file, line);
  if (!line.starts_with("t_s,done_s,frame,"))
    throw std::runtime_error(poses_csv + ": not as expected: " + line);
  while (std::getline(file, line)) {
    Taken taken;
    if (std::sscanf(line.c_str(), "%lf,%lf,%d,", &taken.t_s, &taken.done_s, &taken.frame) != 3)
      throw std::runtime_error(poses_csv + ": " + line);
    taken.frame += first_frame - first_count;
    frames_.push_back(taken);
  }
  if (frames_.size() < 2) throw std::runtime_error(poses_csv + ": fewer than two frames");
}

double FrameClock::frame_at(double t_s) const {
  const auto later = std::upper_bound(frames_.begin() + 1, frames_.end() - 1, t_s,
                                      [](double t, const Taken& taken) { return t < taken.t_s; });
  const Taken& a = *(later - 1);
  const Taken& b = *later;
  return a.frame + (t_s - a.t_s) / (b.t_s - a.t_s) * (b.frame - a.frame);
}

double FrameClock::vision_latency_s() const {
  std::vector<double> latencies_s;
  for (const Taken& taken : frames_) latencies_s.push_back(taken.done_s - taken.t_s);
  const auto median = latencies_s.begin() + static_cast<std::ptrdiff_t>(latencies_s.size() / 2);
  std::nth_element(latencies_s.begin(), median, latencies_s.end());
  return *median;
}

int FrameClock::missing() const {
  return frames_.back().frame - frames_.front().frame + 1 - static_cast<int>(frames_.size());
}

double FrameClock::oldest_view_s() const {
  double oldest_s = 0.0;
  for (std::size_t i = 1; i < frames_.size(); ++i)
    oldest_s = std::max(oldest_s, frames_[i].done_s - frames_[i - 1].t_s);
  return oldest_s;
}

FrameCommands mean_by_frame(const std::vector<SentVelocity>& sent, const FrameClock& clock) {
  constexpr double kRoundingFrames = 1e-6;  // a tick at the time of a frame comes after the frame
  FrameCommands mean;
  std::map<int, int> counts;
  for (const SentVelocity& one : sent) {
    const int frame = static_cast<int>(std::floor(clock.frame_at(one.t_s) + kRoundingFrames));
    if (frame < 0) continue;
    const double weight = 1.0 / ++counts[frame];
    Velocity& velocity = mean[frame];
    velocity.vel_mm_s += weight * (one.velocity.vel_mm_s - velocity.vel_mm_s);
    velocity.rvel_deg_s += weight * (one.velocity.rvel_deg_s - velocity.rvel_deg_s);
  }
  return mean;
}

std::string golden_text(const std::string& header, const FrameCommands& commands) {
  std::string text = header;
  std::string last_row;
  for (const auto& [frame, velocity] : commands) {
    const std::string row = " " + std::to_string(std::lround(velocity.vel_mm_s)) + " " +
                            std::to_string(std::lround(velocity.rvel_deg_s)) + "\n";
    if (row != last_row || frame == commands.rbegin()->first) text += std::to_string(frame) + row;
    last_row = row;
  }
  return text;
}

FrameCommands read_golden(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error(path + ": cannot read");
  FrameCommands commands;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with('#')) continue;
    std::istringstream row(line);
    int frame = 0;
    Velocity velocity;
    if (!(row >> frame >> velocity.vel_mm_s >> velocity.rvel_deg_s))
      throw std::runtime_error(path + ": not \"frame VEL RVEL\": " + line);
    if (!commands.empty()) {
      const auto [last_frame, held] = *commands.rbegin();
      for (int between = last_frame + 1; between < frame; ++between) commands[between] = held;
    }
    commands[frame] = velocity;
  }
  return commands;
}

}  // namespace heel::test
