// Any bytes of a client, cut anywhere, through lines and requests to answers. In addition to the sanitizers'
// checks:
//   * where the bytes are cut changes nothing;
//   * a line is never longer than the bound and two bytes;
//   * a request is good, or has one line of error and no effect but its id;
//   * every answer is one line.
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "fuzz/require.h"
#include "operator/answers.h"
#include "operator/line_buffer.h"
#include "operator/request.h"

namespace {

using namespace heel;
using heel::test::require;

std::vector<std::string> lines_of(std::string_view bytes, std::size_t piece) {
  LineBuffer buffer(kMaxRequestBytes);
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < bytes.size(); at += piece) {
    buffer.feed(bytes.substr(at, piece));
    for (std::string line; buffer.take(line);) {
      require(!line.empty() && line.size() <= kMaxRequestBytes + 2 && line.find('\n') == std::string::npos);
      lines.push_back(line);
    }
  }
  return lines;
}

void check_line(const std::string& text) {
  const ParsedRequest parsed = parse_request(text);
  const Request& request = parsed.request;
  require(parsed.error.find('\n') == std::string::npos && parsed.error.size() < 1000);
  require(!request.id || *request.id >= 0);
  require(request.period_s >= kWatchPeriodMin_s && request.period_s <= kWatchPeriodMax_s);
  require(parsed.error.empty() || (request.assignments.empty() && request.kind == Request().kind));
  require(!parsed.error.empty() || (request.kind == RequestKind::Set) == !request.assignments.empty());
  const std::string answer = parsed.error.empty() ? done_line(request) : error_line(request.id, parsed.error);
  require(answer.find('\n') == std::string::npos);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const std::vector<std::string> lines = lines_of(bytes, size + 1);
  require(lines == lines_of(bytes, 1));
  require(lines == lines_of(bytes, 7));
  for (const std::string& line : lines) check_line(line);
  check_line(std::string(bytes));
  return 0;
}
