#include "operator/web/page_context.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "operator/web/limits.h"
#include "realtime/clock.h"

namespace heel {

void PageContext::warn(const std::string& text) {
  if (warnings.take(monotonic_now_ns())) spdlog::warn("page: {}", text);
}

Presence::Presence(PageContext& context, std::string address)
    : t_active_ns(monotonic_now_ns()), context_(context), address_(std::move(address)) {
  limited_ = !context_.limits.connected(counted_address(address_), t_active_ns);
  if (limited_) context_.warn(address_ + ": too many connections: only an emergency stop is served");
  context_.present.push_back(this);
}

Presence::~Presence() {
  std::erase(context_.present, this);
  context_.limits.disconnected(counted_address(address_));
}

void Presence::active() {
  t_active_ns = monotonic_now_ns();
}

std::string try_token(PageContext& context, const std::string& address, const std::string& token) {
  if (!context.token.set())
    return "heeld has no token (view.token_file): nothing can be changed over the network";
  const std::string counted = counted_address(address);
  const TimeNs now_ns = monotonic_now_ns();
  if (!context.limits.may_try_token(counted, now_ns)) {
    context.warn(address + ": too many tokens were tried; more are refused for a minute");
    return "too many tokens were tried (expected at most 5 a minute)";
  }
  if (!context.token.equals(token)) {
    context.warn(address + ": a wrong token was tried");
    return "not the token of this heeld";
  }
  context.limits.token_was_right(counted, now_ns);
  spdlog::info("page: {} has said the token", address);
  return "";
}

bool make_room(PageContext& context) {
  const auto open = std::count_if(context.present.begin(), context.present.end(),
                                  [](const Presence* one) { return !one->closing; });
  if (static_cast<std::size_t>(open) < kMaxPageConnections) return true;
  Presence* oldest = nullptr;
  for (Presence* one : context.present) {
    if (one->closing || !one->close) continue;
    if (oldest == nullptr || one->t_active_ns < oldest->t_active_ns) oldest = one;
  }
  if (oldest == nullptr) return false;
  oldest->closing = true;
  oldest->close();
  return true;
}

}  // namespace heel
