// One client of the operator thread: its bytes in and out, bounded, and never waited for.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "heel/time.h"
#include "operator/line_buffer.h"
#include "operator/request.h"

namespace heel {

/// At most so many events in a second, averaged; a burst may have as many at once.
class RateLimit {
 public:
  explicit RateLimit(double per_s) : per_s_(per_s), left_(per_s) {}
  /// False: too many.
  bool allow(TimeNs now_ns);

 private:
  double per_s_;
  double left_;
  TimeNs t_last_ns_ = 0;
};

/// What a client watches.
struct Watch {
  std::optional<std::int64_t> id;
  TimeNs period_ns = 0;
  TimeNs t_sent_ns = 0;
  bool changed = true;  ///< something has changed since the last line
};

/// Whether a client may do more than read and stop the robot; another thread may change it.
using MayWrite = std::shared_ptr<const std::atomic<bool>>;

class Connection {
 public:
  static constexpr std::size_t kMaxWaitingBytes = 64 * 1024;  ///< answers that the client has not read
  static constexpr double kRequestsPerS = 100.0;

  /// Owns the socket `fd`, which does not block. A process of this computer, which may write.
  Connection(int fd, std::uint64_t number, TimeNs now_ns);
  /// Somebody else; `may_write` is not null.
  Connection(int fd, std::uint64_t number, TimeNs now_ns, std::string who, MayWrite may_write);
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  int fd() const { return fd_; }
  std::uint64_t number() const { return number_; }
  /// "user 1000, process 4711".
  const std::string& who() const { return who_; }
  /// A process of this computer, through the local socket.
  bool local() const { return !may_write_; }
  bool may_write() const { return !may_write_ || may_write_->load(std::memory_order_acquire); }

  /// Reads what has come, at most 4 KiB. False: nothing had come.
  bool read();
  /// Reads what has come, at most as much as a socket holds by default.
  void read_all();
  bool take_line(std::string& line) { return in_.take(line); }
  /// True once, when input has ended within a line.
  bool take_partial_end();

  /// Keeps a line for the client and sends as much as it takes. A client that does not read is given up.
  void send_line(std::string_view line);
  void flush();

  /// No more requests are read, and it watches no more; what waits is still sent.
  void close_after_answers() {
    closing_ = input_ended_ = true;
    watch.reset();
  }
  bool closing() const { return closing_; }
  /// The client has closed its end for both directions: it receives no answer.
  bool peer_gone() const;
  bool input_ended() const { return input_ended_; }
  bool wants_to_write() const { return !out_.empty(); }
  /// It can be removed: the client is gone or given up, or everything is done.
  bool finished() const { return broken_ || (input_ended_ && open_requests == 0 && !watch && out_.empty()); }
  void give_up() { broken_ = true; }

  // Kept by the server:
  RateLimit rate{kRequestsPerS};
  std::optional<Watch> watch;
  int open_requests = 0;  ///< whose answers are still to come
  TimeNs t_active_ns;     ///< the newest request

 private:
  int fd_;
  std::uint64_t number_;
  std::string who_;
  MayWrite may_write_;  // null: it may
  LineBuffer in_{kMaxRequestBytes};
  std::string out_;
  bool input_ended_ = false;
  bool closing_ = false;
  bool partial_reported_ = false;
  bool broken_ = false;
};

}  // namespace heel
