#include "arcos/parser.h"

#include <algorithm>

#include "arcos/checksum.h"

namespace arcos {

void Parser::push(std::uint8_t byte, std::int64_t t_ns) {
  if (end_ == bytes_.size()) {
    // Not full from 0: drain() leaves less than one packet, and the buffer holds the longest packet.
    std::copy(bytes_.begin() + begin_, bytes_.begin() + end_, bytes_.begin());
    std::copy(t_ns_.begin() + begin_, t_ns_.begin() + end_, t_ns_.begin());
    end_ -= begin_;
    begin_ = 0;
  }
  bytes_[end_] = byte;
  t_ns_[end_] = t_ns;
  ++end_;
}

bool Parser::take(Packet& packet) {
  while (begin_ != end_) {
    const std::uint8_t* const candidate = bytes_.data() + begin_;
    const std::size_t size = end_ - begin_;
    if (candidate[0] != kHeader0 || (size > 1 && candidate[1] != kHeader1)) {
      discard_one();
      continue;
    }
    if (size < kHeaderSize) return false;
    const std::size_t count = candidate[2];
    if (count < kMinCount || count > kMaxCount) {
      ++counters_.length_errors;
      discard_one();
      continue;
    }
    if (size < kHeaderSize + count) return false;

    const std::span<const std::uint8_t> body(candidate + kHeaderSize, count - kChecksumSize);
    const std::uint8_t* const sum = body.data() + body.size();
    if (checksum(body) != static_cast<std::uint16_t>(sum[0] << 8 | sum[1])) {
      ++counters_.checksum_errors;
      discard_one();
      continue;
    }
    ++counters_.packets;
    packet = {t_ns_[begin_], body};
    begin_ += kHeaderSize + count;
    return true;
  }
  begin_ = end_ = 0;
  return false;
}

void Parser::discard_one() {
  ++begin_;
  ++counters_.bytes_discarded;
}

void Parser::reset() {
  counters_.bytes_discarded += pending_bytes();
  begin_ = end_ = 0;
}

}  // namespace arcos
