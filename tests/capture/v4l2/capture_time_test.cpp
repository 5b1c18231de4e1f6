// When a frame was captured, by the driver's stamps.
#include <gtest/gtest.h>
#include <linux/videodev2.h>

#include <cstdint>
#include <limits>

#include "capture/v4l2/v4l2_source.h"

namespace heel {
namespace {

v4l2_buffer stamped(std::uint32_t flags, TimeNs t_ns) {
  v4l2_buffer buffer{};
  buffer.flags = flags;
  buffer.timestamp = {t_ns / kNsPerS, t_ns % kNsPerS / kNsPerUs};
  return buffer;
}

TEST(V4l2CaptureTime, FollowsTheFlagsAndRefusesImplausibleStamps) {
  constexpr TimeNs kArrived = 100 * kNsPerS;
  constexpr TimeNs kStamp = kArrived - 30 * kNsPerMs;
  constexpr TimeNs kExposure = 8 * kNsPerMs;
  constexpr std::uint32_t kMonotonic = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
  constexpr std::uint32_t kStart = kMonotonic | V4L2_BUF_FLAG_TSTAMP_SRC_SOE;
  EXPECT_EQ(capture_time_ns(stamped(kMonotonic, kStamp), 0, kArrived), kStamp);
  EXPECT_EQ(capture_time_ns(stamped(kStart, kStamp), kExposure, kArrived), kStamp + kExposure / 2);
  EXPECT_EQ(capture_time_ns(stamped(kMonotonic, kStamp), kExposure, kArrived), kStamp - kExposure / 2);
  EXPECT_EQ(capture_time_ns(stamped(V4L2_BUF_FLAG_TIMESTAMP_UNKNOWN, kStamp), 0, kArrived), kArrived);
  EXPECT_EQ(capture_time_ns(stamped(V4L2_BUF_FLAG_TIMESTAMP_COPY, kStamp), 0, kArrived), kArrived);
  EXPECT_EQ(capture_time_ns(stamped(kMonotonic, kArrived + kNsPerMs), 0, kArrived), kArrived)
      << "in the future";
  EXPECT_EQ(capture_time_ns(stamped(kMonotonic, kArrived - 2 * kNsPerS), 0, kArrived), kArrived) << "stale";
}

TEST(V4l2CaptureTime, RefusesStampsNearTheOverflowOf64BitNanoseconds) {
  constexpr TimeNs kArrived = 100 * kNsPerS;
  // The last full second of 64-bit nanoseconds, the first negative ones after it, and seconds that do not
  // fit.
  for (const std::int64_t t_s :
       {std::int64_t{9223372036}, std::int64_t{-9223372037}, std::numeric_limits<std::int64_t>::min(),
        std::numeric_limits<std::int64_t>::max()}) {
    v4l2_buffer buffer = stamped(V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC, 0);
    buffer.timestamp.tv_sec = t_s;
    EXPECT_EQ(capture_time_ns(buffer, 0, kArrived), kArrived) << t_s;
  }
  for (const TimeNs t_ns : {std::numeric_limits<TimeNs>::min(), std::numeric_limits<TimeNs>::max()}) {
    EXPECT_FALSE(is_plausible_stamp(t_ns, kArrived)) << t_ns;
  }
}

}  // namespace
}  // namespace heel
