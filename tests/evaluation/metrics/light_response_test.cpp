// The delay of a light in made frames, compared with the delay that they were made with.
#include "evaluation/metrics/light_response.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"
#include "heel/error.h"
#include "support/complaint.h"

namespace heel::evaluation {
namespace {

constexpr TimeNs kPeriod_ns = kNsPerS / 30, kExposure_ns = 10 * kNsPerMs, kDequeue_ns = 12 * kNsPerMs;

/// A camera that exposes each frame for 10 ms, stamps it at its end and gives it 12 ms later; `delay_ns`
/// after the switch the light is seen.
struct MadeCamera {
  TimeNs delay_ns = 0;
  double contrast = 60.0;
  std::size_t lit_tiles = 40;  // tiles that show the light
  double noise = 1.0;

  std::vector<LightSwitch> switches{};
  std::vector<LightFrame> frames{};

  void run(int count) {
    Random random(7);
    TimeNs t_ns = kNsPerS;
    for (int i = 0; i < count; ++i) {
      switches.push_back({t_ns, i % 2 == 0});
      t_ns += static_cast<TimeNs>(random.uniform(0.4, 0.8) * 1e9);
    }
    for (TimeNs t = kNsPerS / 2; t + kDequeue_ns < t_ns; t += kPeriod_ns) {
      LightFrame frame{t, t + kDequeue_ns, {}};
      const double share = exposed_share(t);
      for (std::size_t i = 0; i < frame.tiles.size(); ++i) {
        const bool shows = i >= 100 && i < 100 + lit_tiles;
        const double level = 40.0 + (shows ? contrast * share : 0.0) + noise * random.normal();
        frame.tiles[i] = static_cast<float>(level);
      }
      frames.push_back(frame);
    }
  }

  /// Of the exposure that ends at `t_ns`, in ten samples.
  double exposed_share(TimeNs t_ns) const {
    int on = 0;
    for (int sample = 0; sample < 10; ++sample) {
      const TimeNs at_ns = t_ns - kExposure_ns + sample * kExposure_ns / 10 - delay_ns;
      bool lit = false;
      for (const LightSwitch& light : switches)
        if (light.t_ns <= at_ns) lit = light.on;
      on += lit;
    }
    return 0.1 * on;
  }

  double mean_latency_ms(const LightResponse& response) const {
    double sum = 0.0;
    for (const LightSeen& seen : response.seen)
      sum += 1e-6 * static_cast<double>(frames[seen.frame].t_dequeued_ns - switches[seen.switched].t_ns);
    return sum / static_cast<double>(response.seen.size());
  }
};

TEST(LightResponse, TheDelayIsThatOfTheCamera) {
  for (const TimeNs delay_ms : {0, 20, 70}) {
    MadeCamera camera{.delay_ns = delay_ms * kNsPerMs};
    camera.run(40);
    const LightResponse response = light_response(camera.frames, camera.switches);
    EXPECT_EQ(response.tiles, 40U);
    EXPECT_NEAR(response.contrast, 60.0, 1.0);
    ASSERT_EQ(response.seen.size(), 40U);
    // Half of an exposure must have passed, half a period on average until the next frame, and its reading.
    EXPECT_NEAR(camera.mean_latency_ms(response), static_cast<double>(delay_ms) + 5.0 + 16.7 + 12.0, 4.0);
    for (const LightSeen& seen : response.seen) {
      const double ms = 1e-6 * static_cast<double>(camera.frames[seen.frame].t_dequeued_ns -
                                                   camera.switches[seen.switched].t_ns);
      EXPECT_GE(ms, static_cast<double>(delay_ms) + 16.9);
      EXPECT_LE(ms, static_cast<double>(delay_ms) + 16.0 + 12.0 + 34.0);
    }
  }
}

TEST(LightResponse, ALightThatTheCameraDoesNotShowIsRefused) {
  MadeCamera dark{.contrast = 0.0};
  dark.run(20);
  EXPECT_THAT(test::complaint_of([&] { light_response(dark.frames, dark.switches); }),
              testing::HasSubstr("no part of the picture follows it"));
  MadeCamera noisy{.contrast = 20.0, .noise = 40.0};
  noisy.run(20);
  EXPECT_THROW(light_response(noisy.frames, noisy.switches), Error);
}

TEST(LightResponse, AFewTilesMayBeChance) {
  MadeCamera few{.lit_tiles = 3}, enough{.lit_tiles = 4};
  few.run(20);
  enough.run(20);
  EXPECT_THAT(test::complaint_of([&] { light_response(few.frames, few.switches); }),
              testing::HasSubstr("3 of 768 parts do"));
  EXPECT_EQ(light_response(enough.frames, enough.switches).tiles, 4U);
}

/// Things that move in the picture, brighter and darker at their own times.
TEST(LightResponse, WhatChangesByItselfIsNoLight) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    MadeCamera camera{.contrast = 0.0};
    camera.run(16);
    Random random(seed);
    for (std::size_t things = 0; things < 40; ++things) {
      const std::size_t first = static_cast<std::size_t>(random.index(700));
      const double period_s = random.uniform(0.8, 6.0), phase = random.uniform(0.0, 6.3);
      for (LightFrame& frame : camera.frames)
        for (std::size_t tile = first; tile < first + 8; ++tile)
          frame.tiles[tile] += static_cast<float>(
              25.0 * std::sin(phase + 6.283 * seconds_from_ns(frame.t_capture_ns) / period_s));
    }
    EXPECT_THROW(light_response(camera.frames, camera.switches), Error) << seed;
  }
}

TEST(LightResponse, WithoutFramesNothingIsSeen) {
  const std::vector<LightSwitch> switches{{kNsPerS, true}, {2 * kNsPerS, false}};
  EXPECT_THAT(test::complaint_of([&] { light_response({}, switches); }),
              testing::HasSubstr("too few frames"));
}

/// A camera that stops: what it has not shown is not counted as seen.
TEST(LightResponse, SwitchesThatNoFrameShowsAreLeftOut) {
  MadeCamera camera{.delay_ns = 20 * kNsPerMs};
  camera.run(20);
  std::erase_if(camera.frames, [&](const LightFrame& frame) {
    return frame.t_dequeued_ns > camera.switches[8].t_ns && frame.t_dequeued_ns < camera.switches[12].t_ns;
  });
  const LightResponse response = light_response(camera.frames, camera.switches);
  EXPECT_EQ(response.seen.size(), 16U);
  for (const LightSeen& seen : response.seen) EXPECT_TRUE(seen.switched < 8 || seen.switched >= 12);
}

TEST(LightResponse, TilesAreMeansOfEqualParts) {
  std::vector<std::uint8_t> pixels(64 * 48);
  for (std::size_t y = 0; y < 48; ++y)
    for (std::size_t x = 0; x < 64; ++x) pixels[y * 64 + x] = static_cast<std::uint8_t>(x / 2 + 4 * (y / 2));
  FrameView frame;
  frame.header.width_px = 64;
  frame.header.height_px = 48;
  frame.grey = pixels.data();
  frame.stride_bytes = 64;
  const TileLevels levels = tile_levels(frame);
  EXPECT_FLOAT_EQ(levels[0], 0.f);
  EXPECT_FLOAT_EQ(levels[31], 31.f);
  EXPECT_FLOAT_EQ(levels[32], 4.f);
  EXPECT_FLOAT_EQ(levels[kTileColumns * kTileRows - 1], 31.f + 92.f);
}

}  // namespace
}  // namespace heel::evaluation
