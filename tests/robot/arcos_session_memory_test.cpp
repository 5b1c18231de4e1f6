// After construction a session does not allocate: not while it connects, nor with damaged bytes, nor when the
// line is lost.
#include <gtest/gtest.h>

#include "robot/session_bench.h"
#include "support/allocation_count.h"

namespace heel {
namespace {

TEST(ArcosSessionMemory, NoAllocationAfterConstruction) {
  if (!test::counts_allocations()) GTEST_SKIP() << "a sanitizer owns the allocator";
  test::ScriptedRobot robot;
  ArcosSession session(test::bench_config());
  TimeNs now_ns = kNsPerS;
  std::uint64_t allocations = 0;
  const auto counted = [&](auto&& call) {
    const std::uint64_t before = test::allocations_of_this_thread();
    call();
    allocations += test::allocations_of_this_thread() - before;
  };
  counted([&] { session.line_opened(now_ns); });
  for (int i = 0; i < 1000; ++i) {
    now_ns += test::kTick_ns;
    if (i == 400) robot.mute = true;
    if (i == 700) robot.mute = false;
    test::Bytes said = robot.speak(now_ns);
    if (i % 17 == 0 && !said.empty()) said.back() ^= 1;
    test::Bytes written;
    written.reserve(1024);
    counted([&] {
      session.receive(said, now_ns);
      session.advance(now_ns);
      const auto bytes = session.send({now_ns, now_ns + kNsPerS, 0.3, 0.2, 0}, now_ns);
      written.assign(bytes.begin(), bytes.end());
      SessionEvent event;
      while (session.next_event(event)) {
      }
    });
    robot.receive(written, 0, now_ns);
  }
  counted([&] { session.close(now_ns); });
  EXPECT_EQ(allocations, 0u);
  EXPECT_GE(session.state().reconnects, 1u);  // the line was lost and came back
  EXPECT_GE(session.state().checksum_errors, 1u);
}

}  // namespace
}  // namespace heel
