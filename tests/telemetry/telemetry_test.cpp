// The telemetry thread: all records arrive; changes are logged once, repeated events at most once a second,
// and losses always.
#include "telemetry/telemetry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <thread>

#include "support/collected_log.h"
#include "support/exported.h"
#include "support/process.h"
#include "support/temporary_folder.h"
#include "telemetry/event_text.h"

namespace heel {
namespace {

using testing::HasSubstr;

Event event_of(EventKind kind, TimeNs t_ns, const char* text = "") {
  Event event;
  event.t_ns = t_ns;
  event.kind = kind;
  std::strncpy(event.text.data(), text, event.text.size() - 1);
  return event;
}

const TelemetryConfig kNothingRecorded{.directory = "", .black_box = ""};

class TelemetryTest : public testing::Test {
 protected:
  TelemetryQueues queues_;
  test::CollectedLog log_;
};

TEST_F(TelemetryTest, ChangesOfStopReasonAndLinkAreLoggedOnce) {
  Telemetry telemetry(queues_, kNothingRecorded);
  TickRecord tick;
  for (const StopReason reason : {StopReason::NoTargetYet, StopReason::NoTargetYet, StopReason::None,
                                  StopReason::None, StopReason::TargetLost, StopReason::None}) {
    tick.stop_reason = reason;
    tick.input.robot.phase = LinkPhase::Running;
    ++tick.tick;
    queues_.ticks.push(tick);
  }
  tick.input.robot.phase = LinkPhase::Lost;
  queues_.ticks.push(tick);
  telemetry.drain(kNsPerS);
  EXPECT_EQ(log_.count("at rest: no target seen yet"), 1);
  EXPECT_EQ(log_.count("at rest: target lost"), 1);
  EXPECT_EQ(log_.count("following"), 2);
  EXPECT_EQ(log_.count("link to the robot: running"), 1);
  EXPECT_EQ(log_.count("[warning] link to the robot: lost"), 1);
  EXPECT_EQ(telemetry.snapshot().ticks, 7u);
  EXPECT_EQ(telemetry.snapshot().tick.tick, 6u);
}

TEST_F(TelemetryTest, AChangeOfStateIsLoggedWithItsCause) {
  Telemetry telemetry(queues_, kNothingRecorded);
  TickRecord tick;
  tick.needs_start = true;
  queues_.ticks.push(tick);
  tick.state = SupervisorState::Following;
  tick.stop_reason = StopReason::None;
  tick.cause = TransitionCause::TargetGood;
  queues_.ticks.push(tick);
  tick.state = SupervisorState::Stopped;
  tick.stop_reason = StopReason::Bumper;
  tick.cause = TransitionCause::Bumper;
  queues_.ticks.push(tick);
  tick.state = SupervisorState::Idle;
  tick.cause = TransitionCause::Reset;
  queues_.ticks.push(tick);
  telemetry.drain(kNsPerS);
  EXPECT_EQ(log_.count("at rest: not started; `heel start` lets the robot move"), 1);
  EXPECT_EQ(log_.count("following (following: target good)"), 1);
  EXPECT_EQ(log_.count("at rest: bumper pressed; when it is over, `heel start` (stopped: bumper pressed)"),
            1);
  EXPECT_EQ(log_.count("(idle: reset by the operator)"), 1);
}

TEST_F(TelemetryTest, WhatTheGateHoldsByIsLoggedAtMostOnceASecond) {
  Telemetry telemetry(queues_, kNothingRecorded);
  TickRecord tick;
  tick.state = SupervisorState::Following;
  tick.stop_reason = StopReason::None;
  tick.free_distance_m = 0.416;
  const auto push = [&](TimeNs now_ns, Hold hold) {
    tick.input.now_ns = now_ns;
    tick.hold = hold;
    queues_.ticks.push(tick);
  };
  push(kNsPerS, Hold::None);
  for (int i = 0; i < 10; ++i)
    push(2 * kNsPerS + i * kNsPerMs, i % 2 == 0 ? Hold::ObstacleAhead : Hold::None);
  push(4 * kNsPerS, Hold::None);
  telemetry.drain(5 * kNsPerS);
  EXPECT_EQ(log_.count("held: 0.42 m to an echo ahead"), 1);
  EXPECT_EQ(log_.count("following"), 2);
}

TEST_F(TelemetryTest, WeakBrakesAreLoggedAgainOnlyWhenTheyAreWeaker) {
  Telemetry telemetry(queues_, kNothingRecorded);
  TickRecord tick;
  tick.input.robot.limits.deceleration_m_s2 = 1.5;
  for (const double planned_m_s2 : {1.5, 0.5, 0.5, 0.48, 0.3, 0.3}) {
    tick.planned_deceleration_m_s2 = planned_m_s2;
    tick.brakes_are_weaker = planned_m_s2 < 1.0;
    queues_.ticks.push(tick);
  }
  telemetry.drain(kNsPerS);
  EXPECT_EQ(log_.count("[warning] the robot slowed down with"), 2);
  EXPECT_EQ(log_.count("slowed down with 0.50 m/s² where 1.50 were planned"), 1);
  EXPECT_EQ(log_.count("slowed down with 0.30 m/s² where 1.50 were planned"), 1);
}

TEST_F(TelemetryTest, ARefusalIsLoggedWithItsGateWhenItChanges) {
  Telemetry telemetry(queues_, kNothingRecorded);
  TickRecord tick;
  const auto push = [&](TimeNs now_ns, MeasurementStatus measurement, PoseReason reason) {
    tick.input.now_ns = now_ns;
    tick.measurement = measurement;
    tick.input.pose.reason = reason;
    queues_.ticks.push(tick);
  };
  for (int i = 0; i < 5; ++i) push(kNsPerS, MeasurementStatus::NotFound, PoseReason::Ambiguous);
  push(kNsPerS, MeasurementStatus::NotFound, PoseReason::TooFewMatches);  // too soon
  push(2 * kNsPerS, MeasurementStatus::NotFound, PoseReason::TooFewMatches);
  push(3 * kNsPerS, MeasurementStatus::Accepted, PoseReason::Found);
  push(4 * kNsPerS, MeasurementStatus::Outlier, PoseReason::Found);
  push(4 * kNsPerS, MeasurementStatus::None, PoseReason::Found);
  telemetry.drain(5 * kNsPerS);
  EXPECT_EQ(log_.count("shirt not found: ambiguous"), 1);
  EXPECT_EQ(log_.count("shirt not found: too few matches"), 1);
  EXPECT_EQ(log_.count("pose not used: outlier"), 1);
}

TEST_F(TelemetryTest, WhatThePicturesShowWrongIsLoggedWhenItChanges) {
  Telemetry telemetry(queues_, kNothingRecorded);
  TickRecord tick;
  for (const PictureFault fault : {PictureFault::None, PictureFault::Dark, PictureFault::Dark,
                                   PictureFault::Flicker, PictureFault::None, PictureFault::None}) {
    tick.input.pose.picture = fault;
    queues_.ticks.push(tick);
  }
  telemetry.drain(kNsPerS);
  EXPECT_EQ(log_.count("the picture is dark"), 1);
  EXPECT_EQ(log_.count("the light flickers"), 1);
  EXPECT_EQ(log_.count("the pictures are good again"), 1);
}

TEST_F(TelemetryTest, AnotherTemplateIsLogged) {
  Telemetry telemetry(queues_, kNothingRecorded);
  TickRecord tick;
  for (const std::uint32_t index : {0u, 1u, 1u, 0u}) {
    tick.measurement = MeasurementStatus::Accepted;
    tick.input.pose.template_index = index;
    queues_.ticks.push(tick);
  }
  telemetry.drain(kNsPerS);
  EXPECT_EQ(log_.count("template 1 is in use"), 1);
  EXPECT_EQ(log_.count("template 0 is in use"), 1);
}

TEST_F(TelemetryTest, EventsOfEveryThreadAreLoggedRepeatedOnesAtMostOnceASecond) {
  Telemetry telemetry(queues_, kNothingRecorded);
  queues_.capture_events.push(event_of(EventKind::CameraLost, 1, "sim:yard: gone"));
  queues_.control_events.push(event_of(EventKind::Note, 2, "a note from control"));
  queues_.control_events.push(event_of(EventKind::Warning, 3, "from control"));
  for (int i = 0; i < 50; ++i) {
    queues_.capture_events.push(event_of(EventKind::FrameCorrupt, kNsPerS + i * 50 * kNsPerMs, "bad"));
  }
  telemetry.drain(4 * kNsPerS);
  EXPECT_EQ(log_.count("[warning] camera lost: sim:yard: gone"), 1);
  EXPECT_EQ(log_.count("[info] a note from control"), 1);
  EXPECT_EQ(log_.count("[warning] from control"), 1);
  EXPECT_EQ(log_.count("frame corrupt"), 3) << "2.5 s of them";
  EXPECT_EQ(telemetry.snapshot().events, 53u);
}

TEST_F(TelemetryTest, LostRecordsAreCountedAndLogged) {
  Telemetry telemetry(queues_, kNothingRecorded);
  const std::size_t capacity = queues_.ticks.capacity();
  for (std::size_t i = 0; i < capacity + 9; ++i) queues_.ticks.push(TickRecord{});
  telemetry.drain(10 * kNsPerS);
  telemetry.drain(20 * kNsPerS);
  EXPECT_EQ(log_.count("9 records lost"), 1);
  EXPECT_EQ(telemetry.snapshot().records_lost, 9u);
  EXPECT_EQ(telemetry.snapshot().ticks, capacity);
}

// As in the daemon, other threads push and the telemetry thread records; after stop() no record is missing.
TEST_F(TelemetryTest, EveryPushedRecordIsInTheRecordingAfterStop) {
  const test::TemporaryFolder folder;
  Telemetry telemetry(queues_, {.directory = folder.path(), .black_box = ""});
  constexpr int kRecords = 500;
  std::jthread reader([&] { telemetry.run(); });
  std::jthread control([&] {
    TickRecord tick;
    for (tick.tick = 1; tick.tick <= kRecords; ++tick.tick) {
      while (!queues_.ticks.push(tick)) std::this_thread::yield();
    }
  });
  std::jthread vision([&] {
    PoseEstimate pose;
    for (pose.frame_sequence = 1; pose.frame_sequence <= kRecords; ++pose.frame_sequence) {
      while (!queues_.poses.push(pose)) std::this_thread::yield();
    }
  });
  std::jthread capture([&] {
    for (CaptureCounters counts{.captured = 1}; counts.captured <= kRecords; ++counts.captured) {
      while (!queues_.captures.push(counts)) std::this_thread::yield();
    }
  });
  EXPECT_TRUE(test::eventually([&] { return telemetry.snapshot().ticks > 0; })) << "read from a third thread";
  control.join();
  vision.join();
  capture.join();
  telemetry.stop();
  reader.join();
  test::exported(folder.path());
  for (const char* name : {"ticks.csv", "poses.csv", "capture.csv"}) {
    const std::string text = test::read_text(folder.file(name));
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), kRecords + 1) << name;
  }
  EXPECT_THAT(test::read_text(folder.file("events.log")), HasSubstr("at rest: not started"));
  EXPECT_EQ(telemetry.snapshot().tick.tick, std::uint64_t{kRecords});
  EXPECT_EQ(telemetry.snapshot().pose.frame_sequence, std::uint64_t{kRecords});
  EXPECT_EQ(telemetry.snapshot().capture.captured, std::uint64_t{kRecords});
}

TEST(EventText, GivesTheEventWithItsNumbers) {
  EXPECT_EQ(event_text(event_of(EventKind::CameraOpened, 0, "sim:yard: 640x480")),
            "camera opened: sim:yard: 640x480");
  Event late = event_of(EventKind::Overrun, 0);
  late.a = 3;
  late.b = 45'500'000;
  EXPECT_EQ(event_text(late), "deadline missed: 45.500 ms late, 3 periods missed so far");
  EXPECT_EQ(event_text(event_of(EventKind::Note, 0, "just so")), "just so");
  Event numbered = event_of(EventKind::Warning, 0, "attempt {} failed");
  numbered.a = 2;
  EXPECT_EQ(event_text(numbered), "attempt 2 failed");
  Event full = event_of(EventKind::Note, 0);
  full.text.fill('x');  // no zero at the end
  EXPECT_EQ(event_text(full).size(), full.text.size());
}

}  // namespace
}  // namespace heel
