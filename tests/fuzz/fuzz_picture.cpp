// Any bytes as a picture. In addition to the sanitizers' checks: there is a grey picture in one block of
// memory, or a problem in one line.
#include <cstdint>
#include <string>

#include "files/image_file.h"
#include "fuzz/memory_file.h"
#include "fuzz/require.h"

namespace {

using heel::test::require;

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const heel::test::MemoryFile file(data, size);
  const heel::GreyImage image = heel::decode_grey_image(file.path());
  require(image.grey.empty() != image.problem.empty());
  require(image.problem.find('\n') == std::string::npos);
  if (!image.grey.empty()) require(image.grey.type() == CV_8U && image.grey.isContinuous());
  return 0;
}
