#include "sim/transport/robot_server.h"

namespace heel::sim {
namespace {

constexpr std::size_t kMostBacklog = 2048;  // more stays with the client's kernel, which then blocks it

}  // namespace

void RobotServer::listen(TimeNs t_ns) {
  watch_client(t_ns);
  read_client(t_ns);
}

void RobotServer::speak(TimeNs t_ns) {
  robot_.advance(t_ns);
  t_last_ns_ = t_ns;
  const std::vector<std::uint8_t> out = robot_.take_output();
  if (!out.empty()) transport_.write(out);
  for (const RobotEvent& event : robot_.take_events()) on_event_(event.t_ns, describe(event));
}

void RobotServer::watch_client(TimeNs t_ns) {
  const bool present = transport_.client_present();
  if (present == client_present_) return;
  client_present_ = present;
  on_event_(t_ns, present ? "client connected" : "client gone");
  if (!present) robot_.line_dropped();
}

void RobotServer::read_client(TimeNs t_ns) {
  std::size_t size = 0;
  if (robot_.input_backlog() < kMostBacklog) size = transport_.read(buffer_);
  const std::span<const std::uint8_t> bytes(buffer_.data(), size);
  if (size > 0 && on_received_) on_received_(t_ns, bytes);

  // Nobody can tell whether bytes found together with a new rate were sent before or after the change. They
  // count as sent at the rate the robot understands, if it is one of the two.
  const int baud = transport_.host_baud();
  const bool sent_before = baud != host_baud_ && host_baud_ == robot_.baud();
  if (sent_before && size > 0) robot_.receive(bytes, t_last_ns_);
  if (baud != host_baud_) {
    host_baud_ = baud;
    robot_.set_host_baud(baud);
  }
  if (!sent_before && size > 0) robot_.receive(bytes, t_last_ns_);
}

}  // namespace heel::sim
