// The capture thread's loop with a scripted source: outages, corrupt frames, end of stream, stop; and with
// the simulator's channel: no allocation in steady state.
#include "daemon/capture_loop.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <deque>
#include <functional>
#include <thread>
#include <vector>

#include "capture/shared_memory/sim_source.h"
#include "capture/synthetic_frames.h"
#include "realtime/clock.h"
#include "support/allocation_count.h"

namespace heel {
namespace {

constexpr std::uint32_t kWidth = 20;
constexpr std::uint32_t kHeight = 4;

// Gives a list of openings and results; after the end of the list every wait times out.
class ScriptedSource final : public FrameSource {
 public:
  ScriptedSource() : FrameSource("test:script"), pixels_(kWidth * kHeight) { description_ = "a script"; }

  OpenResult open() override {
    opened_at_ns.push_back(monotonic_now_ns());
    if (openings.empty()) return OpenResult::Opened;
    const OpenResult result = openings.front();
    openings.pop_front();
    if (result == OpenResult::Opened) return result;
    return fail(result, result == OpenResult::Absent ? "not there" : "not allowed");
  }
  FrameResult wait_frame(TimeNs timeout_ns, FrameView& frame) override {
    if (results.empty()) {
      if (on_idle) on_idle();
      sleep_until_ns(monotonic_now_ns() + std::min(timeout_ns, kNsPerMs));
      return FrameResult::Timeout;
    }
    const FrameResult result = results.front();
    results.pop_front();
    if (result == FrameResult::Error) ++counters_.corrupt;
    if (result != FrameResult::Frame) return fail(result, "scripted");
    FrameHeader header;
    test::make_frame({&header, pixels_.data(), kWidth}, ++sequence_, kWidth, kHeight);
    header.width_px = width_px;
    frame = {header, pixels_.data(), kWidth};
    return result;
  }
  void close() override { ++closed; }

  std::deque<OpenResult> openings;
  std::deque<FrameResult> results;
  std::vector<TimeNs> opened_at_ns;
  std::function<void()> on_idle;
  std::uint32_t width_px = kWidth;
  int closed = 0;

 private:
  std::uint64_t sequence_ = 0;
  std::vector<std::uint8_t> pixels_;
};

class CaptureLoopTest : public testing::Test {
 protected:
  CaptureLoopTest() {
    source_.on_idle = [this] { loop_.stop(); };
  }

  std::vector<EventKind> kinds() {
    std::vector<EventKind> result;
    for (Event event; events_.pop(event);) result.push_back(event.kind);
    return result;
  }

  FrameTripleBuffer ring_{kWidth, kHeight};
  SpscQueue<CaptureCounters> counts_{64};
  SpscQueue<Event> events_{64};
  ScriptedSource source_;
  CaptureLoop loop_{
      source_, ring_, counts_, events_, {.reopen_first_ns = kNsPerMs, .reopen_longest_ns = 8 * kNsPerMs}};
};

using enum FrameResult;

TEST_F(CaptureLoopTest, FramesGoIntoTheTripleBuffer) {
  source_.results = {Frame, Frame, Timeout, Frame};
  loop_.run();
  EXPECT_EQ(loop_.counters().captured, 3u);
  EXPECT_EQ(loop_.counters().dropped_unread, 2u);
  const FrameView* frame = ring_.take();
  ASSERT_NE(frame, nullptr);
  EXPECT_EQ(frame->header.sequence, 3u);
  EXPECT_TRUE(test::is_whole(*frame));
  EXPECT_EQ(source_.closed, 1) << "the loop closes the source when it ends";
  EXPECT_THAT(kinds(), testing::ElementsAre(EventKind::CameraOpened));
}

TEST_F(CaptureLoopTest, ALostSourceIsReportedOnceAndOpenedAgainWithGrowingPauses) {
  source_.openings = {OpenResult::Opened, OpenResult::Absent, OpenResult::Absent,
                      OpenResult::Absent, OpenResult::Absent, OpenResult::Opened};
  source_.results = {Frame, Lost, Frame};
  loop_.run();
  EXPECT_EQ(loop_.counters().captured, 2u);
  EXPECT_EQ(loop_.counters().reopened, 1u);
  EXPECT_THAT(kinds(), testing::ElementsAre(EventKind::CameraOpened, EventKind::CameraLost,
                                            EventKind::CameraUnavailable, EventKind::CameraOpened));
  ASSERT_EQ(source_.opened_at_ns.size(), 6u);
  // Pauses of 1, 2, 4, 8 ms; a pause is never shorter.
  for (std::size_t i = 2; i < 6; ++i) {
    EXPECT_GE(source_.opened_at_ns[i] - source_.opened_at_ns[i - 1], kNsPerMs << (i - 2)) << i;
  }
}

TEST_F(CaptureLoopTest, ASourceLostBeforeItsFirstFrameIsOpenedWithGrowingPauses) {
  source_.results = {Lost, Lost, Lost, Frame, Lost, Lost};
  loop_.run();
  ASSERT_EQ(source_.opened_at_ns.size(), 6u);
  const auto between_ns = [this](std::size_t i) {
    return source_.opened_at_ns[i] - source_.opened_at_ns[i - 1];
  };
  // 1, 2, 4 ms without a frame; after a frame the series starts again: no pause, then 1 ms.
  EXPECT_GE(between_ns(1), kNsPerMs);
  EXPECT_GE(between_ns(2), 2 * kNsPerMs);
  EXPECT_GE(between_ns(3), 4 * kNsPerMs);
  EXPECT_GE(between_ns(5), kNsPerMs);
}

TEST_F(CaptureLoopTest, AfterAFrameThePausesStartAgainFromTheShortest) {
  // A busy machine may lengthen a pause; without the new start it is at least 256 ms each time.
  TimeNs shortest_ns = kNsPerS;
  for (int attempt = 0; attempt < 5 && shortest_ns >= 200 * kNsPerMs; ++attempt) {
    ScriptedSource source;
    CaptureLoop loop(source, ring_, counts_, events_,
                     {.reopen_first_ns = kNsPerMs, .reopen_longest_ns = kNsPerS});
    source.on_idle = [&] { loop.stop(); };
    source.results = {Lost, Lost, Lost, Lost, Lost, Lost, Lost, Lost, Frame, Lost, Lost};
    loop.run();
    ASSERT_EQ(source.opened_at_ns.size(), 11u);
    shortest_ns = std::min(shortest_ns, source.opened_at_ns[10] - source.opened_at_ns[9]);
  }
  EXPECT_LT(shortest_ns, 200 * kNsPerMs);
}

TEST_F(CaptureLoopTest, AnEmptyStreamIsRestartedWithGrowingPauses) {
  source_.results = {EndOfStream, EndOfStream, Frame};
  CaptureLoop endless(
      source_, ring_, counts_, events_,
      {.reopen_first_ns = kNsPerMs, .reopen_longest_ns = 8 * kNsPerMs, .restart_at_end = true});
  source_.on_idle = [&] { endless.stop(); };
  endless.run();
  ASSERT_EQ(source_.opened_at_ns.size(), 3u);
  EXPECT_GE(source_.opened_at_ns[1] - source_.opened_at_ns[0], kNsPerMs);
  EXPECT_GE(source_.opened_at_ns[2] - source_.opened_at_ns[1], 2 * kNsPerMs);
}

TEST_F(CaptureLoopTest, EventsCarryTheProblemAndItsTime) {
  source_.openings = {OpenResult::Refused};
  const TimeNs before_ns = monotonic_now_ns();
  loop_.run();
  Event event;
  ASSERT_TRUE(events_.pop(event));
  EXPECT_EQ(event.kind, EventKind::CameraUnavailable);
  EXPECT_STREQ(event.text.data(), "test:script: not allowed");
  EXPECT_GE(event.t_ns, before_ns);
  EXPECT_LE(event.t_ns, monotonic_now_ns());
}

TEST_F(CaptureLoopTest, EveryNewReasonInAnOutageIsReported) {
  source_.openings = {OpenResult::Absent, OpenResult::Absent, OpenResult::Refused, OpenResult::Refused,
                      OpenResult::Opened};
  source_.results = {Frame};
  loop_.run();
  EXPECT_THAT(kinds(), testing::ElementsAre(EventKind::CameraUnavailable, EventKind::CameraUnavailable,
                                            EventKind::CameraOpened));
}

TEST_F(CaptureLoopTest, UnusableFramesAreCountedAndTheLoopContinues) {
  source_.results = {Frame, Error, Error, Frame};
  loop_.run();
  EXPECT_EQ(loop_.counters().captured, 2u);
  EXPECT_EQ(loop_.counters().dropped_by_driver, 2u);
}

TEST_F(CaptureLoopTest, CountersAreRecordedOnlyWhenTheyHaveChanged) {
  source_.openings = {OpenResult::Opened, OpenResult::Opened};
  source_.results = {Frame, Timeout, Timeout, Frame, Error, Lost, Frame};
  const TimeNs before_ns = monotonic_now_ns();
  loop_.run();
  struct Told {
    std::uint64_t captured, dropped_by_driver, dropped_unread, reopened;
    bool operator==(const Told&) const = default;
  };
  std::vector<Told> told;
  TimeNs t_last_ns = before_ns;
  for (CaptureCounters c; counts_.pop(c);) {
    told.push_back({c.captured, c.dropped_by_driver, c.dropped_unread, c.reopened});
    EXPECT_GE(c.t_ns, t_last_ns);
    t_last_ns = c.t_ns;
  }
  EXPECT_LE(t_last_ns, monotonic_now_ns());
  EXPECT_THAT(told, testing::ElementsAre(Told{1, 0, 0, 0}, Told{2, 0, 1, 0}, Told{2, 1, 1, 0},
                                         Told{2, 1, 1, 1}, Told{3, 1, 2, 1}));
}

TEST_F(CaptureLoopTest, FramesOfAnotherSizeAreRefusedAndReportedOnce) {
  source_.width_px = kWidth - 1;
  source_.results = {Frame, Frame, Frame};
  loop_.run();
  EXPECT_EQ(loop_.counters().captured, 0u);
  EXPECT_THAT(kinds(), testing::ElementsAre(EventKind::CameraOpened, EventKind::FrameRefused));
}

TEST_F(CaptureLoopTest, TheEndOfAStreamEndsTheLoop) {
  source_.results = {Frame, EndOfStream};
  EXPECT_FALSE(loop_.ended());
  loop_.run();
  EXPECT_TRUE(loop_.ended());
  EXPECT_THAT(kinds(), testing::ElementsAre(EventKind::CameraOpened, EventKind::CameraEnded));
}

TEST_F(CaptureLoopTest, StopEndsALongPause) {
  source_.openings = {OpenResult::Absent};
  CaptureLoop slow(source_, ring_, counts_, events_,
                   {.wait_ns = kNsPerMs, .reopen_first_ns = 60 * kNsPerS, .reopen_longest_ns = 60 * kNsPerS});
  const TimeNs start_ns = monotonic_now_ns();
  std::jthread thread([&] { slow.run(); });
  for (Event event; !events_.pop(event);) std::this_thread::yield();  // the pause follows the event
  sleep_until_ns(monotonic_now_ns() + 20 * kNsPerMs);
  slow.stop();
  thread.join();
  EXPECT_LT(monotonic_now_ns() - start_ns, 30 * kNsPerS);
}

// Passes calls on to a source, and counts the allocations of its thread from the first frame to the latest
// call.
class AllocationCountingSource final : public FrameSource {
 public:
  explicit AllocationCountingSource(FrameSource& source) : FrameSource(source.address()), source_(source) {}

  OpenResult open() override { return source_.open(); }
  FrameResult wait_frame(TimeNs timeout_ns, FrameView& frame) override {
    if (seen_first_) allocations = test::allocations_of_this_thread() - before_;
    const FrameResult result = source_.wait_frame(timeout_ns, frame);
    if (result != FrameResult::Frame) return result;
    if (!seen_first_) before_ = test::allocations_of_this_thread();
    seen_first_ = true;
    return result;
  }
  void close() override { source_.close(); }

  std::uint64_t allocations = 0;

 private:
  FrameSource& source_;
  bool seen_first_ = false;
  std::uint64_t before_ = 0;
};

TEST(CaptureLoopMemory, DoesNotAllocateInSteadyState) {
  if (!test::counts_allocations()) GTEST_SKIP() << "a sanitizer owns the allocator";
  const std::string name = "test-" + std::to_string(getpid()) + "-loop";
  SimChannelWriter writer(name, kWidth, kHeight);
  SimSource channel(name);
  AllocationCountingSource source(channel);
  FrameTripleBuffer ring(kWidth, kHeight);
  SpscQueue<CaptureCounters> counts(8);
  SpscQueue<Event> events(8);
  CaptureLoop loop(source, ring, counts, events);

  std::jthread thread([&] { loop.run(); });
  for (Event event; !events.pop(event);)
    std::this_thread::yield();  // the source is open: it sees every frame from now on
  for (std::uint64_t sequence = 1; sequence <= 200; ++sequence) {
    test::make_frame(writer.writable(), sequence, kWidth, kHeight);
    writer.publish();
    while (ring.captured() < sequence) std::this_thread::yield();
  }
  loop.stop();
  thread.join();
  EXPECT_EQ(loop.counters().captured, 200u);
  EXPECT_EQ(source.allocations, 0u);
}

}  // namespace
}  // namespace heel
