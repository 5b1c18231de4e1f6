// Any bytes as a recording. In addition to the sanitizers' checks: the reader ends, and says so when it did
// not come to the end of the file.
#include <cstdint>
#include <cstdlib>
#include <sstream>
#include <string>

#include "heel/error.h"
#include "mcap/mcap_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace heel;
  // Half of the inputs get a good beginning, so that what stands behind it is reached.
  std::string bytes(size % 2 == 0 ? std::string(kMcapMagic.data(), kMcapMagic.size()) : std::string());
  bytes.append(reinterpret_cast<const char*>(data), size);
  std::istringstream file(bytes);
  try {
    McapReader reader(file, "fuzz.mcap");
    for (McapMessage message; reader.next(message);) reader.channel(message.channel);
    if (!reader.complete() && reader.problems().empty()) std::abort();
  } catch (const Error&) {
    return 0;
  }
  return 0;
}
