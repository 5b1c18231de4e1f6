// Automatic exposure in its steps, and frames that are lost or late.
#include "sim/render/exposure.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/render/frame_timing.h"

namespace heel::sim {
namespace {

double brightness(const Exposure& now) {
  return now.light * now.exposure_ms / 8.0 * now.gain;
}

TEST(Exposure, FixedFollowsTheLight) {
  const ExposureControl fixed({}, 8.0, {{10.0, 0.25}}, 60.0);
  EXPECT_EQ(brightness(fixed.at(9.99)), 1.0);
  EXPECT_EQ(brightness(fixed.at(10.0)), 0.25);
  EXPECT_EQ(fixed.at(10.0).gain, 1.0);
}

TEST(Exposure, AutomaticStepsUpFirstByTheShutterThenByGain) {
  ExposureSettings settings;
  settings.automatic = true;
  settings.longest_ms = 16.0;
  const ExposureControl control(settings, 8.0, {{10.0, 0.1}, {30.0, 1.0}}, 60.0);
  EXPECT_EQ(brightness(control.at(9.0)), 1.0);
  EXPECT_NEAR(brightness(control.at(10.01)), 0.1, 1e-12);  // it does not know yet
  double before = brightness(control.at(10.01));
  for (double t = 10.1; t < 20; t += 0.1) {
    const Exposure now = control.at(t);
    const double step = brightness(now) / before;
    EXPECT_TRUE(std::abs(step - 1) < 1e-9 || std::abs(step - std::sqrt(2)) < 1e-9) << t;  // half a stop
    if (now.gain > 1.0) {
      EXPECT_NEAR(now.exposure_ms, 16.0, 1e-9) << t;
    }
    before = brightness(now);
  }
  EXPECT_NEAR(std::log2(before), 0.0, 0.3);  // to within a step
  EXPECT_GT(control.at(29).gain, 3.0);
  EXPECT_NEAR(brightness(control.at(30.01)), 10 * before, 1e-9);  // blinded
  EXPECT_NEAR(std::log2(brightness(control.at(40))), 0.0, 0.3);
}

TEST(Exposure, AutomaticHasLimits) {
  ExposureSettings settings;
  settings.automatic = true;
  settings.longest_ms = 16.0;
  settings.most_gain = 2.0;
  const ExposureControl control(settings, 8.0, {{1.0, 0.01}}, 60.0);
  EXPECT_NEAR(control.at(50).exposure_ms, 16.0, 1e-9);
  EXPECT_NEAR(control.at(50).gain, 2.0, 1e-9);
}

TEST(FrameDelivery, SharesAreMet) {
  FrameTimingSettings settings;
  settings.drop_share = 0.1;
  settings.late_share = 0.2;
  settings.late_ms = 80;
  settings.jitter_ms = 2;
  int dropped = 0, late = 0;
  double jitter2 = 0;
  constexpr int kFrames = 20000;
  for (int i = 0; i < kFrames; ++i) {
    const FrameDelivery delivery = frame_delivery(settings, 3, static_cast<std::uint64_t>(i));
    dropped += delivery.dropped;
    late += delivery.delay_ns > 0;
    if (delivery.delay_ns > 0) {
      EXPECT_GE(delivery.delay_ns, ns_from_seconds(0.02));
      EXPECT_LE(delivery.delay_ns, ns_from_seconds(0.08));
    }
    EXPECT_LE(std::abs(seconds_from_ns(delivery.stamp_error_ns)), 0.006 + 1e-9);
    jitter2 += std::pow(seconds_from_ns(delivery.stamp_error_ns), 2) / kFrames;
  }
  EXPECT_NEAR(dropped, 2000, 150);
  EXPECT_NEAR(late, 4000, 200);
  EXPECT_NEAR(std::sqrt(jitter2), 0.002, 0.0001);
  // Seed and number of a frame decide how it is delivered; settings without faults cause none.
  EXPECT_EQ(frame_delivery(settings, 3, 5).stamp_error_ns, frame_delivery(settings, 3, 5).stamp_error_ns);
  EXPECT_NE(frame_delivery(settings, 4, 5).stamp_error_ns, frame_delivery(settings, 3, 5).stamp_error_ns);
  EXPECT_NE(frame_delivery(settings, 3, 6).stamp_error_ns, frame_delivery(settings, 3, 5).stamp_error_ns);
  const FrameDelivery calm = frame_delivery({}, 3, 5);
  EXPECT_FALSE(calm.dropped);
  EXPECT_EQ(calm.delay_ns + calm.stamp_error_ns, 0);
}

}  // namespace
}  // namespace heel::sim
