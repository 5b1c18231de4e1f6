// The hops of frames whose stamps are given.
#include "evaluation/reports/latency_figures.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "support/complaint.h"
#include "support/temporary_folder.h"
#include "telemetry/recorder.h"

namespace heel::evaluation {
namespace {

using ::testing::HasSubstr;

constexpr TimeNs kBegin_ns = 1000 * kNsPerS;
constexpr int kFrames = 100;
constexpr TimeNs kFramePeriod_ns = 40 * kNsPerMs;
constexpr int kSpeedUpEvery = 4;
constexpr double kStep_m_s = 0.02;

/// Frame k is had 5 ms after its exposure, begun at 6 ms and done at 16 ms, the last frame at 26 ms; ticks
/// come every 20 ms, of which the one at 20 ms uses the frame (the last frame: the one at 40 ms) and writes
/// 0.5 ms later. The command of every fourth frame begins a ramp of 20 mm/s a tick, which ends with that
/// frame.
void record_frames(Recorder& recorder, bool with_timings) {
  double v_m_s = 0.0;
  for (int k = 0; k < kFrames; ++k) {
    const TimeNs t_ns = kBegin_ns + k * kFramePeriod_ns;
    const bool slow = k == kFrames - 1;
    // The camera is opened again in the middle, and counts from 0 again.
    const auto frame = static_cast<std::uint64_t>(k % (kFrames / 2));
    if (with_timings)
      recorder.record(FrameTiming{frame, t_ns, t_ns + 5 * kNsPerMs, t_ns + 6 * kNsPerMs,
                                  t_ns + (slow ? 26 : 16) * kNsPerMs});
    for (const TimeNs after_ns : {20 * kNsPerMs, 40 * kNsPerMs}) {
      TickRecord tick;
      tick.input.now_ns = t_ns + after_ns;
      tick.input.has_pose = true;
      tick.input.pose.t_capture_ns = slow && after_ns < 40 * kNsPerMs ? t_ns - kFramePeriod_ns : t_ns;
      if (k % kSpeedUpEvery == 0) v_m_s += kStep_m_s;
      tick.command.v_m_s = v_m_s;
      recorder.record(tick);
      recorder.record(WireBytes{.t_ns = t_ns + after_ns + kNsPerMs / 2, .to_robot = true, .count = 7});
      recorder.record(WireBytes{.t_ns = t_ns + after_ns + kNsPerMs / 4, .to_robot = false, .count = 7});
    }
  }
}

std::string recorded(const test::TemporaryFolder& folder, bool with_timings) {
  const std::string path = folder.file("run.mcap");
  Recorder recorder(path, RecordingClock{});
  record_frames(recorder, with_timings);
  return path;
}

TEST(LatencyFigures, EachHopHasItsMedianItsPercentileAndItsLongest) {
  const test::TemporaryFolder folder;
  const LatencyFigures figures = latency_of(recorded(folder, true));
  EXPECT_EQ(figures.frames, static_cast<std::size_t>(kFrames));
  EXPECT_EQ(figures.commands, static_cast<std::size_t>(kFrames));
  EXPECT_DOUBLE_EQ(figures.period_ms, 20.0);
  ASSERT_EQ(figures.hops.size(), 5u);
  const double p50[]{5.0, 1.0, 10.0, 4.0, 0.5}, longest[]{5.0, 1.0, 20.0, 14.0, 0.5};
  for (std::size_t i = 0; i < figures.hops.size(); ++i) {
    EXPECT_NEAR(figures.hops[i].p50_ms, p50[i], 1e-9) << figures.hops[i].name;
    EXPECT_NEAR(figures.hops[i].p99_ms, p50[i], 1e-9) << figures.hops[i].name << ": one of 100 is slow";
    EXPECT_NEAR(figures.hops[i].max_ms, longest[i], 1e-9) << figures.hops[i].name;
    EXPECT_EQ(figures.hops[i].count, static_cast<std::size_t>(kFrames));
  }
  EXPECT_NEAR(figures.total.p50_ms, 20.5, 1e-9);
  EXPECT_NEAR(figures.total.max_ms, 40.5, 1e-9);
  EXPECT_NEAR(figures.dequeued_to_last.max_ms, 35.5, 1e-9);
  ASSERT_EQ(figures.slowest_ms.size(), 6u);
  EXPECT_NEAR(figures.slowest_ms[3], 26.0, 1e-9) << "the slow frame, done";
}

/// The wheels make a command's step between 7 and 9 ms after its last byte.
void write_truth(const std::string& path, TimeNs begin_ns) {
  std::ofstream csv(path);
  csv << "t_monotonic_s,wheel_left_m_s,wheel_right_m_s\n";
  double v_m_s = 0.0;
  const auto row = [&](TimeNs t_ns) {
    csv << fmt::format("{:.6f},{:.5f},{:.5f}\n", seconds_from_ns(t_ns), v_m_s - 0.1, v_m_s + 0.1);
  };
  row(begin_ns);
  for (int k = 0; k < kFrames; k += kSpeedUpEvery) {
    for (const TimeNs tick_ns : {20 * kNsPerMs, 40 * kNsPerMs}) {
      const TimeNs t_ns = begin_ns + k * kFramePeriod_ns + tick_ns + kNsPerMs / 2;
      row(t_ns + 7 * kNsPerMs);
      v_m_s += kStep_m_s;
      row(t_ns + 9 * kNsPerMs);
    }
  }
}

TEST(LatencyFigures, TheWheelsAreTheLastHopOfCommandsThatChangeTheSpeed) {
  const test::TemporaryFolder folder;
  const std::string recording = recorded(folder, true), truth = folder.file("truth.csv");
  write_truth(truth, kBegin_ns);
  const WheelResponse wheels(truth);
  const LatencyFigures figures = latency_of(recording, &wheels);
  ASSERT_EQ(figures.hops.size(), 6u);
  EXPECT_EQ(figures.hops.back().count, static_cast<std::size_t>(kFrames / kSpeedUpEvery));
  EXPECT_NEAR(figures.hops.back().p50_ms, 8.0, 0.01);
  EXPECT_NEAR(figures.hops.back().max_ms, 8.0, 0.01);
  ASSERT_TRUE(figures.to_wheels);
  EXPECT_NEAR(figures.to_wheels->max_ms, 28.5, 0.01);
  ASSERT_EQ(figures.slowest_ms.size(), 7u);
  EXPECT_NEAR(figures.slowest_ms.back(), 28.5, 0.01) << "of those that moved the wheels";
}

TEST(LatencyFigures, TheTruthOfAnotherRunIsRefused) {
  const test::TemporaryFolder folder;
  const std::string recording = recorded(folder, true), truth = folder.file("truth.csv");
  write_truth(truth, kBegin_ns + 100 * kNsPerS);
  const WheelResponse wheels(truth);
  EXPECT_THAT(test::complaint_of([&] { latency_of(recording, &wheels); }),
              HasSubstr("no command of it has moved the wheels of the truth (expected both of one run)"));
}

TEST(LatencyFigures, ARecordingWithoutStampsIsRefused) {
  const test::TemporaryFolder folder;
  const std::string path = recorded(folder, false);
  EXPECT_THAT(test::complaint_of([&] { latency_of(path); }), HasSubstr(path + ": no stamps of frames"));
}

}  // namespace
}  // namespace heel::evaluation
