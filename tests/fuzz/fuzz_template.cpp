// Any bytes as a template file. In addition to the sanitizers' checks: it is refused in
// one line, or it has a picture of its camera's size with the region inside it.
#include <cstdint>
#include <cstdlib>
#include <string>

#include "files/template_file.h"
#include "fuzz/memory_file.h"
#include "heel/error.h"

namespace {

using namespace heel;

void require(bool holds) {
  if (!holds) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const test::MemoryFile file(data, size);
  try {
    const ShirtTemplate shirt = read_template(file.path());
    const auto width_px = static_cast<std::size_t>(shirt.camera.width_px);
    const auto height_px = static_cast<std::size_t>(shirt.camera.height_px);
    require(shirt.grey.size() == width_px * height_px);
    const Region& roi = shirt.roi;
    require(roi.x_px >= 0 && roi.y_px >= 0 && roi.x_px + roi.width_px <= shirt.camera.width_px &&
            roi.y_px + roi.height_px <= shirt.camera.height_px);
  } catch (const Error& error) {
    require(std::string(error.what()).find('\n') == std::string::npos);
  }
  return 0;
}
