// Any text as a configuration file, into which new values are written. In addition to the sanitizers' checks:
// the text is refused, or afterwards it has these values and every other one as before, and nothing is gone
// but the old values.
#include <cstdint>
#include <string>
#include <vector>

#include "config/config_edit.h"
#include "fuzz/require.h"
#include "heel/error.h"

namespace {

using namespace heel;
using heel::test::require;

std::size_t newlines_in(const std::string& text) {
  std::size_t count = 0;
  for (const char c : text) count += c == '\n';
  return count;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  const std::vector<ConfigChange> changes = {{"gate.v_max_m_s", "", "0.125"},
                                             {"runtime.log_level", "", "\"warn\""}};
  try {
    const Config before = parse_config(text, "fuzz.toml").config;
    const std::string edited = edited_config_text(text, "fuzz.toml", changes);
    const Config after = parse_config(edited, "fuzz.toml").config;
    require(after.gate.v_max_m_s == 0.125 && after.runtime.log_level == "warn");
    require(changes_between(before, after).size() <= changes.size());
    require(newlines_in(edited) >= newlines_in(text));
  } catch (const Error&) {
    return 0;
  }
  return 0;
}
