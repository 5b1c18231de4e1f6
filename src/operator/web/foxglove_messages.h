// The Foxglove WebSocket protocol, as Foxglove and Lichtblick speak it: what is sent and understood, without
// the network. Its topics, schemas and messages are those of a recording.
// Source: https://github.com/foxglove/ws-protocol, docs/spec.md (foxglove.websocket.v1; foxglove.sdk.v1 has
// the same messages).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "heel/time.h"
#include "operator/settings.h"
#include "operator/web/view_json.h"
#include "recording/topics.h"

namespace heel {

/// Of the sub-protocols that a client offers ("a, b"), the one that is spoken; empty: none.
std::string foxglove_protocol(std::string_view offered);

/// Topics that are sent live. The number of a channel is that of its Topic.
std::span<const Topic> live_topics();

std::string foxglove_server_info();
std::string foxglove_advertise();
/// `names`: of keys; empty: all. Names that there are not are left out. `id`: of the request; empty: none.
std::string foxglove_parameters(const Config& config, std::span<const std::string> names,
                                const std::string& id);
/// `level`: 1 a warning, 2 an error.
std::string foxglove_status(int level, const std::string& text);
/// A message of a subscription: a head of 13 bytes, then the message.
std::string foxglove_data(std::uint32_t subscription, TimeNs t_log_ns, std::string_view message);
/// The request of the operators' protocol for a setParameters; empty: it names no parameter.
std::string set_request(const ViewJson& parameters, std::int64_t id);

}  // namespace heel
