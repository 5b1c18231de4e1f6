// Any bytes as what browsers send beside the operators' requests: names of hosts and origins, the
// sub-protocol, and messages of a Foxglove viewer. In addition to the sanitizers' checks: a parameter that is
// set becomes a good request or one that is refused in one line, and an origin is not ours that only begins
// like ours.
#include <cstdint>
#include <string>
#include <vector>

#include "fuzz/require.h"
#include "operator/request.h"
#include "operator/web/foxglove_messages.h"
#include "operator/web/origin.h"
#include "operator/web/view_json.h"

namespace {

using namespace heel;
using heel::test::require;

void check_names(const std::string& text) {
  const std::vector<std::string> names = {"robot.example"};
  host_is_ours(text, names);
  require(!origin_is_named("http://robot.example." + text, names) || text.empty() || text.front() == ':');
  if (!text.empty()) origin_is_ours(text, text);
  const std::string protocol = foxglove_protocol(text);
  require(protocol.empty() || text.find(protocol) != std::string::npos);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  check_names(text);
  const ViewJson message = ViewJson::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!message.is_object()) return 0;
  const std::string line = set_request(message.value("parameters", ViewJson()), 1);
  if (!line.empty()) require(parse_request(line).error.find('\n') == std::string::npos);
  return 0;
}
