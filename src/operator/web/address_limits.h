// How many connections an address has, how fast it opens new ones, and how often it tries a token.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

#include "heel/time.h"
#include "operator/web/limits.h"

namespace heel {

/// So many events at once, and so many a second on average.
class Allowance {
 public:
  Allowance(double per_s, double burst) : per_s_(per_s), burst_(burst), left_(burst) {}
  /// False: too many.
  bool take(TimeNs now_ns);
  void give_back(TimeNs now_ns);
  /// Nothing has been taken that has not come back since.
  bool full(TimeNs now_ns) const;

 private:
  double left_at(TimeNs now_ns) const;

  double per_s_, burst_, left_;
  TimeNs t_last_ns_ = 0;
};

/// What one client is counted by: an IPv4 address, or the first 64 bits of an IPv6 one, which is what one
/// connection to the internet usually has to itself. `address` is in numbers, as 192.168.1.7.
std::string counted_address(const std::string& address);

class AddressLimits {
 public:
  /// A connection of the address has come. False: it is beyond the limits.
  bool connected(const std::string& address, TimeNs now_ns);
  void disconnected(const std::string& address);
  /// A token is about to be tried. False: too many tries.
  bool may_try_token(const std::string& address, TimeNs now_ns);
  /// It was the right one: a page that connects often is no guesser.
  void token_was_right(const std::string& address, TimeNs now_ns);

 private:
  struct Counts {
    std::size_t connections = 0;
    Allowance opened, tries;
  };
  Counts& counts_of(const std::string& address, TimeNs now_ns);
  void forget_quiet(TimeNs now_ns);

  std::map<std::string, Counts> counts_;
  Allowance all_tries_{kAllTokenTriesPerMinute / 60.0, kAllTokenTriesPerMinute};
};

}  // namespace heel
