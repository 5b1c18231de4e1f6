#include "operator/web/view_server.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <sys/resource.h>
#include <unistd.h>

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <exception>
#include <string>
#include <utility>

#include "heel/error.h"
#include "operator/web/exposure.h"
#include "operator/web/http_session.h"
#include "operator/web/limits.h"
#include "operator/web/page_context.h"

namespace heel {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;

constexpr TimeNs kLogLook_ns = 250 * kNsPerMs;      // for new lines of the log
constexpr TimeNs kAcceptPause_ns = 100 * kNsPerMs;  // after a connection could not be accepted
constexpr int kNice = 5;                            // the page may wait for what drives the robot

/// Of a value of view.address that the configuration has checked.
tcp::endpoint endpoint_of(const std::string& address) {
  const std::size_t colon = address.rfind(':');
  std::string host = address.substr(0, colon);
  if (host.starts_with('[')) host = host.substr(1, host.size() - 2);
  return {asio::ip::make_address(host), static_cast<std::uint16_t>(std::stoi(address.substr(colon + 1)))};
}

}  // namespace

struct ViewServer::Impl {
  Impl(const ViewConfig& config, const ViewParts& parts, PageFiles files, const Token& token)
      : address(config.address),
        exposure(page_exposure(config)),
        context{
            parts.port,
            parts.operators,
            parts.settings,
            parts.telemetry,
            token,
            LiveHub(parts.feed, parts.log, parts.facts, parts.settings.view().file.robot.model,
                    config.picture_quality),
            HttpAnswers({parts.settings, parts.telemetry, parts.feed, context.hub, parts.log, parts.facts},
                        std::move(files), token.set())},
        feed(parts.feed),
        acceptor(context.io),
        look_timer(context.io),
        accept_timer(context.io) {
    listen();
    feed.on_news([this] { asio::post(context.io, [this] { context.hub.send_news(); }); });
  }

  void listen();
  void accept();
  void look();

  const std::string address, exposure;
  PageContext context;
  LiveFeed& feed;
  tcp::acceptor acceptor;
  asio::steady_timer look_timer, accept_timer;
};

void ViewServer::Impl::listen() {
  try {
    const tcp::endpoint endpoint = endpoint_of(address);
    acceptor.open(endpoint.protocol());
    acceptor.set_option(tcp::acceptor::reuse_address(true));
    acceptor.bind(endpoint);
    acceptor.listen();
  } catch (const boost::system::system_error& error) {
    throw Error(
        fmt::format("view.address: {}: {} (expected an address of this computer, and a port that no "
                    "other program serves)",
                    address, error.code().message()));
  }
}

void ViewServer::Impl::accept() {
  acceptor.async_accept([this](boost::system::error_code error, tcp::socket socket) {
    if (error == asio::error::operation_aborted) return;
    if (error) {  // without a pause it would try again at once, for ever
      context.warn("a connection could not be accepted: " + error.message());
      accept_timer.expires_after(std::chrono::nanoseconds(kAcceptPause_ns));
      accept_timer.async_wait([this](boost::system::error_code) { accept(); });
      return;
    }
    const tcp::endpoint peer = socket.remote_endpoint(error);
    if (!error && make_room(context)) {
      auto presence = std::make_unique<Presence>(context, peer.address().to_string());
      std::make_shared<HttpSession>(std::move(socket), context, std::move(presence))->start();
    }
    accept();
  });
}

/// The log has news also when nothing else has.
void ViewServer::Impl::look() {
  look_timer.expires_after(std::chrono::nanoseconds(kLogLook_ns));
  look_timer.async_wait([this](boost::system::error_code error) {
    if (error) return;
    context.hub.send_news();
    look();
  });
}

ViewServer::ViewServer(const ViewConfig& config, const ViewParts& parts, PageFiles files)
    : impl_(std::make_unique<Impl>(config, parts, std::move(files), Token::read(config.token_file))) {}

ViewServer::~ViewServer() {
  impl_->feed.on_news(nullptr);
}

void ViewServer::run() {
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kNice);
  spdlog::info("the page is served at {}, port {}", impl_->address, port());
  spdlog::info("{}", impl_->exposure);
  impl_->accept();
  impl_->look();
  for (bool ended = false; !ended;) {
    try {
      impl_->context.io.run();
      ended = true;
    } catch (const std::exception& error) {  // a defect of the page does not stop the robot's daemon
      spdlog::error("page: {}", error.what());
    }
  }
}

void ViewServer::stop() {
  impl_->context.io.stop();
}

std::uint16_t ViewServer::port() const {
  return impl_->acceptor.local_endpoint().port();
}

}  // namespace heel
