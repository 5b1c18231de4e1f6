#include "sim/transport/robot_server.h"

namespace heel::sim {
namespace {

constexpr std::size_t kMaxBacklog_bytes =
    2048;  // more stays in the kernel's buffer, which then blocks the client

}  // namespace

void RobotServer::receive(TimeNs t_ns) {
  check_client(t_ns);
  read_client(t_ns);
}

void RobotServer::advance(TimeNs t_ns) {
  robot_.advance(t_ns);
  t_last_ns_ = t_ns;
  const std::vector<std::uint8_t> out = robot_.take_output();
  if (!out.empty()) transport_.write(out);
  for (const RobotEvent& event : robot_.take_events()) on_event_(event.t_ns, describe(event));
}

void RobotServer::check_client(TimeNs t_ns) {
  const bool present = transport_.client_present();
  for (std::string news = transport_.take_news(); !news.empty(); news = transport_.take_news())
    on_event_(t_ns, news);
  if (present == client_present_) return;
  client_present_ = present;
  on_event_(t_ns, present ? "client connected" : "client gone");
  if (!present) robot_.line_dropped();
}

void RobotServer::read_client(TimeNs t_ns) {
  std::size_t size = 0;
  if (robot_.input_backlog() < kMaxBacklog_bytes) size = transport_.read(buffer_);
  const std::span<const std::uint8_t> bytes(buffer_.data(), size);
  if (size > 0 && on_received_) on_received_(t_ns, bytes);

  // Bytes found together with a new rate were sent before or after the change: it is not known which. They
  // count as sent at the rate that the robot has, if that is one of the two.
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
