#include "operator/web/origin.h"

#include <arpa/inet.h>
#include <netinet/in.h>

#include <algorithm>
#include <cctype>

namespace heel {
namespace {

bool equal_letters(std::string_view a, std::string_view b) {
  const auto same = [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), same);
}

/// Without the port and the brackets of an IPv6 address.
std::string_view without_port(std::string_view host) {
  if (host.starts_with('[')) {
    const std::size_t end = host.find(']');
    return end == std::string_view::npos ? std::string_view() : host.substr(1, end - 1);
  }
  return host.substr(0, host.rfind(':'));
}

bool is_address(const std::string& host) {
  in6_addr address{};
  return inet_pton(AF_INET, host.c_str(), &address) == 1 || inet_pton(AF_INET6, host.c_str(), &address) == 1;
}

}  // namespace

bool host_is_ours(std::string_view host, std::span<const std::string> names) {
  const std::string name(without_port(host));
  if (name.empty()) return false;
  if (is_address(name) || equal_letters(name, "localhost")) return true;
  return std::any_of(names.begin(), names.end(),
                     [&](const std::string& ours) { return equal_letters(ours, name); });
}

bool origin_is_ours(std::string_view origin, std::string_view host) {
  if (origin.empty()) return true;
  for (const std::string_view scheme : {"http://", "https://"})
    if (origin.starts_with(scheme)) return equal_letters(origin.substr(scheme.size()), host);
  return false;
}

bool origin_is_named(std::string_view origin, std::span<const std::string> names) {
  for (const std::string_view scheme : {"http://", "https://"}) {
    if (!origin.starts_with(scheme)) continue;
    const std::string_view name = without_port(origin.substr(scheme.size()));
    return std::any_of(names.begin(), names.end(),
                       [&](const std::string& ours) { return equal_letters(ours, name); });
  }
  return false;
}

}  // namespace heel
