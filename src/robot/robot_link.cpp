#include "robot/robot_link.h"

#include <algorithm>

#include "core/wire_pieces.h"
#include "realtime/clock.h"

namespace heel {
namespace {

// With more than this unsent in the driver the line is stuck: more bytes would only make the robot execute
// old commands when the line moves again.
constexpr std::size_t kBacklogBytes = 200;
constexpr TimeNs kStuck_ns = kNsPerS;
constexpr TimeNs kShutdown_ns = 250 * kNsPerMs;
constexpr TimeNs kAdapter_ns = 20 * kNsPerMs;  // a USB adapter's own buffering

}  // namespace

RobotLink::RobotLink(const RobotConfig& config, SpscQueue<WireBytes>* wire)
    : session_(config),
      connector_(parse_robot_address(config.address), ns_from_seconds(config.reconnect_s)),
      wire_(wire),
      line_baud_(session_.wanted_baud()) {
  connector_.open(line_baud_);
}

RobotLink::~RobotLink() {
  shutdown(monotonic_now_ns());
}

SerialLine* RobotLink::usable_line(TimeNs now_ns) {
  SerialLine* const line = finished_ ? nullptr : connector_.line();
  if (line == nullptr) return nullptr;
  if (!line_up_) {
    line_up_ = true;
    pending_begin_ = pending_end_ = 0;
    t_progress_ns_ = now_ns;
    session_.line_opened(now_ns);
  }
  if (session_.wanted_baud() != line_baud_) {
    line_baud_ = session_.wanted_baud();
    connector_.retune(line_baud_);
    return nullptr;
  }
  return line;
}

void RobotLink::lose_line(TimeNs now_ns) {
  line_up_ = false;
  session_.line_lost(now_ns);
  line_baud_ = session_.wanted_baud();
  connector_.open(line_baud_);
}

void RobotLink::report(std::span<const std::uint8_t> bytes, bool to_robot, TimeNs t_ns) {
  if (wire_ == nullptr) return;
  for_each_wire_piece(bytes, to_robot, t_ns, [this](const WireBytes& piece) { wire_->push(piece); });
}

void RobotLink::read_all(SerialLine& line, TimeNs now_ns) {
  std::array<std::uint8_t, 512> chunk{};
  // Bounded: a line that never runs dry must not hold the tick.
  for (int i = 0; i < 8; ++i) {
    const SerialLine::Transfer got = line.read(chunk);
    report(std::span(chunk).first(got.count), /*to_robot=*/false, now_ns);
    session_.receive(std::span(chunk).first(got.count), now_ns);
    if (got.status == SerialLine::Status::Lost) return lose_line(now_ns);
    if (got.count < chunk.size()) return;
  }
}

void RobotLink::write_pending(TimeNs now_ns) {
  SerialLine* const line = usable_line(now_ns);
  if (line == nullptr) return;
  const auto waiting = std::span(pending_).subspan(pending_begin_, pending_end_ - pending_begin_);
  const SerialLine::Transfer put = line->write(waiting);
  report(waiting.first(put.count), /*to_robot=*/true, monotonic_now_ns());
  pending_begin_ += put.count;
  if (put.status == SerialLine::Status::Lost) lose_line(now_ns);
}

const RobotState& RobotLink::read(TimeNs now_ns) {
  may_write_ = false;
  if (SerialLine* const line = usable_line(now_ns)) read_all(*line, now_ns);
  if (pending_begin_ != pending_end_) write_pending(now_ns);
  SerialLine* const line = usable_line(now_ns);
  if (line == nullptr) return session_.state();

  if (pending_begin_ == pending_end_ && line->unsent_bytes() < kBacklogBytes) {
    t_progress_ns_ = now_ns;
    session_.advance(now_ns);
    may_write_ = true;
  } else if (now_ns - t_progress_ns_ >= kStuck_ns) {
    lose_line(now_ns);
  }
  if (session_.line_exhausted() && usable_line(now_ns) != nullptr) lose_line(now_ns);
  return session_.state();
}

void RobotLink::write(const VelocityCommand& command, TimeNs now_ns) {
  // None: the line was lost since, or the session wants it at another rate.
  if (!may_write_ || usable_line(now_ns) == nullptr) return;
  const auto bytes = session_.send(command, now_ns);
  std::copy(bytes.begin(), bytes.end(), pending_.begin());
  pending_begin_ = 0;
  pending_end_ = bytes.size();
  write_pending(now_ns);
}

void RobotLink::receive_until(TimeNs deadline_ns) {
  for (;;) {
    const TimeNs now_ns = monotonic_now_ns();
    if (now_ns >= deadline_ns) return;
    SerialLine* const line = usable_line(now_ns);
    const TimeNs left_ns = deadline_ns - now_ns;
    if (line == nullptr) {
      sleep_until_ns(deadline_ns);
    } else if (line->wait_readable(left_ns)) {
      read_all(*line, monotonic_now_ns());
    }
  }
}

void RobotLink::shutdown(TimeNs now_ns) {
  if (finished_) return;
  SerialLine* const line = usable_line(now_ns);
  const auto closing_bytes = session_.close(now_ns);
  finished_ = true;
  if (line == nullptr) return;

  const TimeNs begin_ns = monotonic_now_ns();
  const auto left_ns = [&] { return std::max<TimeNs>(0, kShutdown_ns - (monotonic_now_ns() - begin_ns)); };
  // First the rest of a packet that was begun, or the robot would take STOP for its tail.
  for (auto rest :
       {std::span<const std::uint8_t>(pending_).subspan(pending_begin_, pending_end_ - pending_begin_),
        closing_bytes}) {
    while (!rest.empty() && left_ns() > 0) {
      const SerialLine::Transfer put = line->write(rest);
      if (put.status == SerialLine::Status::Lost) return;
      report(rest.first(put.count), /*to_robot=*/true, monotonic_now_ns());
      rest = rest.subspan(put.count);
      if (put.count == 0) line->drain(2 * kNsPerMs);
    }
  }
  line->drain(left_ns());
  // A driver counts as sent what it has handed to the adapter, and closing the line throws that away.
  const TimeNs on_the_wire_ns = static_cast<TimeNs>(closing_bytes.size()) * 10 * kNsPerS / line_baud_;
  sleep_until_ns(monotonic_now_ns() + std::min(left_ns(), on_the_wire_ns + kAdapter_ns));
}

}  // namespace heel
