// Work shared among threads: every piece is done once, by any thread, and the picture is the same.
#include "sim/render/thread_pool.h"

#include <gtest/gtest.h>

#include <atomic>
#include <vector>

#include "sim/scene/world.h"
#include "support/sanitized.h"

namespace heel::sim {
namespace {

TEST(ThreadPool, EveryPieceIsDoneOnce) {
  for (const int threads : {1, 2, 5}) {
    ThreadPool workers(threads);
    EXPECT_EQ(workers.threads(), threads);
    for (const int count : {0, 1, 7, 480})
      for (int round = 0; round < 50; ++round) {
        std::vector<std::atomic<int>> done(static_cast<std::size_t>(count));
        workers.parallel_for(count, 3, [&](int begin, int end) {
          for (int i = begin; i < end; ++i) ++done[static_cast<std::size_t>(i)];
        });
        for (const std::atomic<int>& times : done) ASSERT_EQ(times, 1);
      }
  }
}

TEST(ThreadPool, AtLeastTheCallerWorks) {
  EXPECT_GE(ThreadPool(0).threads(), 1);
  EXPECT_LE(ThreadPool(0).threads(), 4);
}

TEST(WorldPictureThreads, IsTheSameForAnyNumberOfThreads) {
  Scenario scenario;
  scenario.camera.model = default_camera_model();
  scenario.camera.readout_ms = 20;
  scenario.camera.sensor.glare = 0.1;
  scenario.camera.jpeg_quality = 80;
  scenario.room.windows = 4;
  std::vector<std::uint8_t> alone, shared;
  const RobotMotion robot{-1.7, 0, 0.02, 0.4, 0.3};
  World(scenario, 1).render(robot, 0.5, 7, alone);
  for (const int threads : test::kThreadSanitizer ? std::vector{3} : std::vector{2, 3, 7}) {
    World(scenario, threads).render(robot, 0.5, 7, shared);
    EXPECT_EQ(alone, shared) << threads;
  }
}

}  // namespace
}  // namespace heel::sim
