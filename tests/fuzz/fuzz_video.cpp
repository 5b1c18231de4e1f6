// Any bytes as a video. In addition to the sanitizers' checks: it is refused with a reason, or each frame is
// later than the one before it.
#include <cmath>
#include <cstdint>

#include "files/video_reader.h"
#include "fuzz/memory_file.h"
#include "fuzz/require.h"

namespace {

using heel::test::require;

constexpr int kMaxFrames = 50;

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const heel::test::MemoryFile file(data, size);
  heel::VideoReader video;
  if (!video.open(file.path())) {
    require(!video.problem().empty());
    return 0;
  }
  cv::Mat grey;
  double last_s = -1.0;
  for (int i = 0; i < kMaxFrames && video.read(grey); ++i) {
    require(grey.type() == CV_8U && !grey.empty());
    require(std::isfinite(video.time_s()) && video.time_s() > last_s);
    last_s = video.time_s();
  }
  return video.missing().find('\n') == std::string::npos ? 0 : 1;
}
