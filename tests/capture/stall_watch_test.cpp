#include "capture/stall_watch.h"

#include <gtest/gtest.h>

namespace heel {
namespace {

TEST(StallWatch, GrowsWithEachOpeningThatGaveNoFrame) {
  StallWatch watch;
  for (const TimeNs allowed_s : {4, 8, 16, 16}) {
    watch.opened(0);
    EXPECT_FALSE(watch.stalled(allowed_s * kNsPerS));
    EXPECT_TRUE(watch.stalled(allowed_s * kNsPerS + 1));
  }
  watch.frame(100 * kNsPerS);
  EXPECT_TRUE(watch.stalled(102 * kNsPerS + 1));
  watch.opened(0);
  EXPECT_TRUE(watch.stalled(4 * kNsPerS + 1)) << "a frame has shown that the camera works";
}

}  // namespace
}  // namespace heel
