#include "operator/web/address_limits.h"

#include <arpa/inet.h>
#include <netinet/in.h>

#include <algorithm>
#include <array>

#include "operator/web/limits.h"

namespace heel {
namespace {

constexpr std::size_t kKeptAddresses = 1024;

}  // namespace

double Allowance::left_at(TimeNs now_ns) const {
  return t_last_ns_ == 0 ? left_ : std::min(burst_, left_ + per_s_ * seconds_from_ns(now_ns - t_last_ns_));
}

bool Allowance::take(TimeNs now_ns) {
  left_ = left_at(now_ns);
  t_last_ns_ = now_ns;
  if (left_ < 1.0) return false;
  left_ -= 1.0;
  return true;
}

void Allowance::give_back(TimeNs now_ns) {
  left_ = std::min(burst_, left_at(now_ns) + 1.0);
  t_last_ns_ = now_ns;
}

bool Allowance::full(TimeNs now_ns) const {
  return left_at(now_ns) >= burst_;
}

std::string counted_address(const std::string& address) {
  in6_addr bytes{};
  if (inet_pton(AF_INET6, address.substr(0, address.find('%')).c_str(), &bytes) != 1) return address;
  std::array<char, INET6_ADDRSTRLEN> text{};
  if (IN6_IS_ADDR_V4MAPPED(&bytes)) return inet_ntop(AF_INET, &bytes.s6_addr[12], text.data(), text.size());
  std::fill_n(bytes.s6_addr + 8, 8, std::uint8_t{0});
  return inet_ntop(AF_INET6, &bytes, text.data(), text.size());
}

AddressLimits::Counts& AddressLimits::counts_of(const std::string& address, TimeNs now_ns) {
  const auto found = counts_.find(address);
  if (found != counts_.end()) return found->second;
  if (counts_.size() >= kKeptAddresses) forget_quiet(now_ns);
  const Counts none{0,
                    {kNewConnectionsOfAddress_1_s, kConnectionBurstOfAddress},
                    {kTokenTriesPerMinute / 60.0, kTokenTriesPerMinute}};
  return counts_.emplace(address, none).first->second;
}

/// Those without a connection and without anything counted against them.
void AddressLimits::forget_quiet(TimeNs now_ns) {
  std::erase_if(counts_, [now_ns](const auto& one) {
    const Counts& counts = one.second;
    return counts.connections == 0 && counts.opened.full(now_ns) && counts.tries.full(now_ns);
  });
}

bool AddressLimits::connected(const std::string& address, TimeNs now_ns) {
  Counts& counts = counts_of(address, now_ns);
  ++counts.connections;
  return counts.opened.take(now_ns) && counts.connections <= kMaxConnectionsOfAddress;
}

void AddressLimits::disconnected(const std::string& address) {
  const auto found = counts_.find(address);
  if (found != counts_.end() && found->second.connections > 0) --found->second.connections;
}

bool AddressLimits::may_try_token(const std::string& address, TimeNs now_ns) {
  return counts_of(address, now_ns).tries.take(now_ns) && all_tries_.take(now_ns);
}

void AddressLimits::token_was_right(const std::string& address, TimeNs now_ns) {
  counts_of(address, now_ns).tries.give_back(now_ns);
  all_tries_.give_back(now_ns);
}

}  // namespace heel
