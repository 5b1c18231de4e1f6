// A line to the operator thread for a browser: requests out, answers in.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <functional>
#include <memory>
#include <string>

namespace heel {

class OperatorLink {
 public:
  struct Owner {
    std::weak_ptr<void> kept;  ///< is kept alive while the line is open
    std::function<void(const std::string& line)> answered;
    std::function<void()> ended;
  };

  explicit OperatorLink(boost::asio::io_context& io) : socket_(io) {}
  /// `fd`: of OperatorServer::invite().
  void open(int fd, Owner owner);
  void close();
  /// A request without its end. False: too much waits already.
  bool send(const std::string& request);

 private:
  static constexpr std::size_t kMaxBytes = 256 * 1024;  // a status has a few thousand

  void read_answers();
  void write();

  boost::asio::local::stream_protocol::socket socket_;
  Owner owner_;
  std::string answers_;          // bytes from the operator thread
  std::string waiting_, going_;  // bytes to it
};

}  // namespace heel
