// The WebSockets of the page: live data, and the operators' protocol.
#pragma once

#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <memory>
#include <string>

#include "operator/web/page_context.h"

namespace heel {

using UpgradeRequest = boost::beast::http::request<boost::beast::http::string_body>;

/// Each answers the request and then lives until the connection ends.
void open_live_session(boost::beast::tcp_stream&& stream, PageContext& context,
                       std::unique_ptr<Presence> presence, UpgradeRequest request);
void open_operator_session(boost::beast::tcp_stream&& stream, PageContext& context,
                           std::unique_ptr<Presence> presence, UpgradeRequest request);

/// `protocol`: one that foxglove_protocol() has chosen.
void open_foxglove_session(boost::beast::tcp_stream&& stream, PageContext& context,
                           std::unique_ptr<Presence> presence, UpgradeRequest request,
                           const std::string& protocol);

}  // namespace heel
