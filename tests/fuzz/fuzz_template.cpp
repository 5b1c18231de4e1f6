// Any bytes as a template file. In addition to the sanitizers' checks: it is refused in
// one line, or it has a picture of its camera's size with the region inside it.
#include <cstdint>
#include <string>

#include "files/template_file.h"
#include "fuzz/memory_file.h"
#include "fuzz/require.h"

namespace {

using namespace heel;
using heel::test::require;

void check_template(const std::string& path) {
  const ShirtTemplate shirt = read_template(path);
  const auto width_px = static_cast<std::size_t>(shirt.camera.width_px);
  const auto height_px = static_cast<std::size_t>(shirt.camera.height_px);
  require(shirt.grey.size() == width_px * height_px);
  const Region& roi = shirt.roi;
  require(roi.x_px >= 0 && roi.y_px >= 0 && roi.x_px + roi.width_px <= shirt.camera.width_px &&
          roi.y_px + roi.height_px <= shirt.camera.height_px);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  test::require_read_or_refused(data, size, check_template);
  return 0;
}
