#include "operator/web/operator_link.h"

#include <boost/asio/buffer.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/write.hpp>
#include <utility>

namespace heel {

namespace asio = boost::asio;

void OperatorLink::open(int fd, Owner owner) {
  socket_.assign(asio::local::stream_protocol(), fd);
  owner_ = std::move(owner);
  read_answers();
}

void OperatorLink::close() {
  boost::system::error_code ignored;
  socket_.close(ignored);
}

bool OperatorLink::send(const std::string& request) {
  if (waiting_.size() > kMaxBytes) return false;
  waiting_ += request + '\n';
  if (going_.empty()) write();
  return true;
}

void OperatorLink::write() {
  going_.swap(waiting_);
  asio::async_write(socket_, asio::buffer(going_),
                    [this, kept = owner_.kept.lock()](boost::system::error_code error, std::size_t) {
                      going_.clear();
                      if (!error && !waiting_.empty()) write();
                    });
}

void OperatorLink::read_answers() {
  asio::async_read_until(
      socket_, asio::dynamic_buffer(answers_, kMaxBytes), '\n',
      [this, kept = owner_.kept.lock()](boost::system::error_code error, std::size_t count) {
        if (error) {
          owner_.ended();
          return;
        }
        owner_.answered(answers_.substr(0, count - 1));
        answers_.erase(0, count);
        read_answers();
      });
}

}  // namespace heel
