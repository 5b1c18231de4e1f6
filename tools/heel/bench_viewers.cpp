#include "bench_viewers.h"

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <string>

#include "heel/error.h"

namespace heel::cli {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
using Socket = beast::websocket::stream<asio::ip::tcp::socket>;

asio::ip::tcp::endpoint page_at(std::uint16_t port) {
  return {asio::ip::address_v4::loopback(), port};
}

void require_page(std::uint16_t port) {
  asio::io_context context;
  asio::ip::tcp::socket socket(context);
  boost::system::error_code error;
  socket.connect(page_at(port), error);
  if (error) throw Error("127.0.0.1:" + std::to_string(port) + ": " + error.message());
}

}  // namespace

BenchViewers::BenchViewers(std::uint16_t port, int count) {
  require_page(port);
  for (int i = 0; i < count; ++i) threads_.emplace_back([this, port] { look(port); });
}

BenchViewers::~BenchViewers() {
  stop_ = true;  // the page sends something many times a second: no read waits for long
  for (std::thread& thread : threads_) thread.join();
}

void BenchViewers::look(std::uint16_t port) {
  try {
    asio::io_context context;
    Socket page(context);
    page.next_layer().connect(page_at(port));
    page.handshake("127.0.0.1:" + std::to_string(port), "/live");
    page.write(asio::buffer(std::string(R"({"type":"want","picture":true})")));
    beast::flat_buffer message;
    while (!stop_) {
      message.clear();
      page.read(message);
      if (page.got_text()) continue;
      ++pictures_;
      page.write(asio::buffer(std::string(R"({"type":"picture_shown"})")));
    }
    page.close(beast::websocket::close_code::normal);
  } catch (const boost::system::system_error&) {
    // heeld has ended: who measures it finds that out.
  }
}

}  // namespace heel::cli
