// Any text as a camera file. In addition to the sanitizers' checks: it is refused in one line, or it is a
// camera whose distortion can be undone at opposite corners of the picture.
#include <cstdint>
#include <string>

#include "files/camera_info.h"
#include "fuzz/memory_file.h"
#include "fuzz/require.h"

namespace {

using namespace heel;
using heel::test::require;

void check_camera(const std::string& path) {
  const CameraModel camera = read_camera_model(path);
  require(camera.width_px > 0 && camera.height_px > 0 && camera.fx > 0.0 && camera.fy > 0.0);
  require(camera.undistort_px({0.0, 0.0}).allFinite());
  require(camera.undistort_px({camera.width_px - 1.0, camera.height_px - 1.0}).allFinite());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  test::require_read_or_refused(data, size, check_camera);
  return 0;
}
