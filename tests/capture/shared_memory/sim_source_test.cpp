// The simulator's frame channel: writer and reader; start, end and loss of the writer.
#include "capture/shared_memory/sim_source.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <thread>

#include "capture/synthetic_frames.h"
#include "heel/error.h"
#include "realtime/clock.h"
#include "support/complaint.h"
#include "support/process.h"

namespace heel {
namespace {

using test::is_whole;
using test::make_frame;
using testing::HasSubstr;

constexpr std::uint32_t kWidth = 70;
constexpr std::uint32_t kHeight = 9;

// A name that no other process uses.
std::string own_name(const std::string& what) {
  return "test-" + std::to_string(getpid()) + "-" + what;
}

void publish(SimChannelWriter& writer, std::uint64_t sequence) {
  make_frame(writer.writable(), sequence, kWidth, kHeight);
  writer.publish();
}

TEST(SimChannel, BadNamesAreRefused) {
  EXPECT_EQ(sim_channel_path("yard.1_b-2"), "/heel-sim-yard.1_b-2");
  for (const char* name : {"", "a/b", "a b", "ä"}) EXPECT_THROW(sim_channel_path(name), Error) << name;
  EXPECT_THROW(sim_channel_path(std::string(65, 'a')), Error);
}

TEST(SimSource, IsAbsentUntilTheSimulatorStarts) {
  const std::string name = own_name("absent");
  SimSource source(name);
  EXPECT_EQ(source.open(), OpenResult::Absent);
  EXPECT_THAT(source.problem(), HasSubstr("sim:" + name));
  FrameView frame;
  EXPECT_EQ(source.wait_frame(0, frame), FrameResult::Lost);
  const SimChannelWriter writer(name, kWidth, kHeight);
  EXPECT_EQ(source.open(), OpenResult::Opened);
  EXPECT_EQ(source.wait_frame(0, frame), FrameResult::Timeout);
}

TEST(SimSource, GivesTheNewestFrameOnceAndCountsSkippedFrames) {
  const std::string name = own_name("newest");
  SimChannelWriter writer(name, kWidth, kHeight);
  publish(writer, 3);  // before the channel is opened: too old to be given
  SimSource source(name);
  ASSERT_EQ(source.open(), OpenResult::Opened);
  FrameView frame;
  EXPECT_EQ(source.wait_frame(0, frame), FrameResult::Timeout);
  publish(writer, 10);
  ASSERT_EQ(source.wait_frame(0, frame), FrameResult::Frame);
  EXPECT_EQ(frame.header.sequence, 10u);
  EXPECT_EQ(frame.header.width_px, kWidth);
  EXPECT_EQ(frame.header.height_px, kHeight);
  EXPECT_TRUE(is_whole(frame));
  EXPECT_EQ(source.wait_frame(0, frame), FrameResult::Timeout);
  for (std::uint64_t sequence = 11; sequence <= 30; ++sequence) publish(writer, sequence);
  ASSERT_EQ(source.wait_frame(0, frame), FrameResult::Frame);
  EXPECT_EQ(frame.header.sequence, 30u);
  EXPECT_TRUE(is_whole(frame));
  EXPECT_EQ(source.counters().dropped_by_driver, 19u);
}

TEST(SimSource, TheWriterTakesSmallerFramesThanTheChannelAndRefusesLargerOnes) {
  const std::string name = own_name("sizes");
  SimChannelWriter writer(name, kWidth, kHeight);
  SimSource source(name);
  ASSERT_EQ(source.open(), OpenResult::Opened);
  make_frame(writer.writable(), 1, 31, 4);
  writer.publish();
  FrameView frame;
  ASSERT_EQ(source.wait_frame(0, frame), FrameResult::Frame);
  EXPECT_EQ(frame.header.width_px, 31u);
  EXPECT_EQ(frame.header.height_px, 4u);
  EXPECT_TRUE(is_whole(frame));
  writer.writable().header->width_px = kWidth + 1;
  EXPECT_THROW(writer.publish(), Error);
}

TEST(SimSource, AWaitEndsWhenAFrameComes) {
  const std::string name = own_name("wait");
  SimChannelWriter writer(name, kWidth, kHeight);
  SimSource source(name);
  ASSERT_EQ(source.open(), OpenResult::Opened);
  const TimeNs before_ns = monotonic_now_ns();
  std::jthread later([&] {
    sleep_until_ns(before_ns + 20 * kNsPerMs);
    publish(writer, 1);
  });
  FrameView frame;
  EXPECT_EQ(source.wait_frame(600 * kNsPerS, frame), FrameResult::Frame);
  EXPECT_LT(monotonic_now_ns() - before_ns, 300 * kNsPerS);
}

TEST(SimSource, IsAbsentWhenTheWriterHasClosedButStillHoldsTheName) {
  const std::string name = own_name("farewell");
  const SimChannelWriter writer(name, kWidth, kHeight);
  const int fd = shm_open(sim_channel_path(name).c_str(), O_RDWR | O_CLOEXEC, 0);
  ASSERT_GE(fd, 0);
  void* memory = mmap(nullptr, sizeof(SimChannelHeader), PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
  ASSERT_NE(memory, MAP_FAILED);
  static_cast<SimChannelHeader*>(memory)->closed.store(1);
  SimSource source(name);
  EXPECT_EQ(source.open(), OpenResult::Absent);
  EXPECT_THAT(source.problem(), HasSubstr("has ended"));
  munmap(memory, sizeof(SimChannelHeader));
  ::close(fd);
}

TEST(SimSource, IsLostWhenTheSimulatorEndsAndFoundWhenItStartsAgain) {
  const std::string name = own_name("restart");
  SimSource source(name);
  FrameView frame;
  for (std::uint64_t life = 1; life <= 3; ++life) {
    auto writer = std::make_unique<SimChannelWriter>(name, kWidth, kHeight);
    ASSERT_EQ(source.open(), OpenResult::Opened) << source.problem();
    publish(*writer, life);
    ASSERT_EQ(source.wait_frame(0, frame), FrameResult::Frame);
    EXPECT_EQ(frame.header.sequence, life);
    writer.reset();
    const TimeNs before_ns = monotonic_now_ns();
    EXPECT_EQ(source.wait_frame(600 * kNsPerS, frame), FrameResult::Lost);
    EXPECT_LT(monotonic_now_ns() - before_ns, 300 * kNsPerS) << "not after the timeout";
    source.close();
    EXPECT_EQ(source.open(), OpenResult::Absent);
  }
}

TEST(SimChannel, ASecondSimulatorOfTheSameNameIsRefused) {
  const std::string name = own_name("two");
  const SimChannelWriter writer(name, kWidth, kHeight);
  EXPECT_THAT(test::complaint_of([&] { const SimChannelWriter second(name, kWidth, kHeight); }),
              HasSubstr("another simulator"));
  SimSource source(name);
  EXPECT_EQ(source.open(), OpenResult::Opened) << "the first one still serves the channel";
}

TEST(SimSource, AKilledSimulatorIsDetectedAndReplaced) {
  const std::string name = own_name("killed");
  test::Process simulator([&] {
    SimChannelWriter writer(name, kWidth, kHeight);
    publish(writer, 1);
    if (write(STDOUT_FILENO, "ready", 5) != 5) return;
    while (true) pause();
  });
  ASSERT_TRUE(simulator.says("ready"));

  SimSource source(name);
  ASSERT_EQ(source.open(), OpenResult::Opened);
  FrameView frame;
  EXPECT_EQ(source.wait_frame(kNsPerMs, frame), FrameResult::Timeout)
      << "the simulator is alive and sends nothing";
  simulator.signal(SIGKILL);
  ASSERT_EQ(simulator.wait(), -SIGKILL);
  EXPECT_EQ(source.wait_frame(kNsPerMs, frame), FrameResult::Lost);
  EXPECT_EQ(source.open(), OpenResult::Absent) << "its segment remains, its process does not";

  SimChannelWriter next(name, kWidth, kHeight);
  ASSERT_EQ(source.open(), OpenResult::Opened) << source.problem();
  publish(next, 2);
  ASSERT_EQ(source.wait_frame(0, frame), FrameResult::Frame);
  EXPECT_EQ(frame.header.sequence, 2u);
}

// Shared memory of other programs or of a newer simulator is refused by name and does not crash the reader.
TEST(SimSource, ForeignAndNewerSegmentsAreRefused) {
  const std::string name = own_name("foreign");
  auto writer = std::make_unique<SimChannelWriter>(name, kWidth, kHeight);
  const int fd = shm_open(sim_channel_path(name).c_str(), O_RDWR, 0);
  ASSERT_GE(fd, 0);
  auto* header = static_cast<SimChannelHeader*>(
      mmap(nullptr, sizeof(SimChannelHeader), PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0));
  close(fd);
  ASSERT_NE(header, MAP_FAILED);
  SimSource source(name);

  header->version = 2;
  EXPECT_EQ(source.open(), OpenResult::Refused);
  EXPECT_THAT(source.problem(), HasSubstr("version 2 (expected 1)"));
  header->version = kSimChannelVersion;

  header->magic.store(0);
  EXPECT_EQ(source.open(), OpenResult::Absent);
  header->magic.store(42);
  EXPECT_EQ(source.open(), OpenResult::Refused);
  EXPECT_THAT(source.problem(), HasSubstr("not a frame channel"));
  header->magic.store(kSimChannelMagic);

  const std::uint64_t slot_bytes = header->slot_bytes;
  header->slot_bytes = std::uint64_t{1} << 62;  // multiplied by the number of slots it overflows to zero
  EXPECT_EQ(source.open(), OpenResult::Refused);
  header->slot_bytes = slot_bytes;
  header->max_height_px *= 100;
  EXPECT_EQ(source.open(), OpenResult::Refused);
  EXPECT_THAT(source.problem(), HasSubstr("contradicts"));
  munmap(header, sizeof(SimChannelHeader));
}

// The lock of a slot that is being written is odd. The slot is not given, and the reader does not wait
// endlessly.
TEST(SimSource, ASlotThatIsBeingWrittenIsNotGiven) {
  const std::string name = own_name("locked");
  SimChannelWriter writer(name, kWidth, kHeight);
  SimSource source(name);
  ASSERT_EQ(source.open(), OpenResult::Opened);
  publish(writer, 1);
  const int fd = shm_open(sim_channel_path(name).c_str(), O_RDWR, 0);
  ASSERT_GE(fd, 0);
  struct stat file {};
  ASSERT_EQ(fstat(fd, &file), 0);
  const auto bytes = static_cast<std::size_t>(file.st_size);
  auto* channel =
      static_cast<SimChannelHeader*>(mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0));
  close(fd);
  ASSERT_NE(channel, MAP_FAILED);
  std::atomic<std::uint64_t>& lock = sim_slot(channel, 1)->lock;
  FrameView frame;
  lock.fetch_add(1);
  EXPECT_EQ(source.wait_frame(kNsPerMs, frame), FrameResult::Timeout);
  lock.fetch_sub(1);
  EXPECT_EQ(source.wait_frame(kNsPerMs, frame), FrameResult::Frame);
  EXPECT_TRUE(is_whole(frame));
  munmap(channel, bytes);
}

TEST(SimSource, UnderStressFramesAreWholeAndNeverGoBackwards) {
  const std::string name = own_name("stress");
  SimChannelWriter writer(name, kWidth, kHeight);
  SimSource source(name);
  ASSERT_EQ(source.open(), OpenResult::Opened);
  constexpr std::uint64_t kFrames = 20'000;
  std::jthread producer([&] {
    for (std::uint64_t sequence = 1; sequence <= kFrames; ++sequence) publish(writer, sequence);
  });
  FrameView frame;
  std::uint64_t first = 0, last = 0, given = 0;
  while (last < kFrames) {
    ASSERT_EQ(source.wait_frame(60 * kNsPerS, frame), FrameResult::Frame);
    ASSERT_TRUE(is_whole(frame)) << "frame " << frame.header.sequence;
    ASSERT_GT(frame.header.sequence, last);
    ++given;
    last = frame.header.sequence;
    if (first == 0) first = last;  // a frame before the first one given is not a drop
  }
  EXPECT_EQ(given + source.counters().dropped_by_driver, kFrames - first + 1);
}

/// The calling thread runs on the processor on which it is now, and on no other.
void stay_on_this_processor() {
  cpu_set_t one;
  CPU_ZERO(&one);
  CPU_SET(static_cast<unsigned>(sched_getcpu()), &one);
  ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
}

// A reader that shares its processor with another thread is often interrupted while it copies a frame.
// Meanwhile the writer writes every slot again. Each frame has one grey value, so that writing and checking
// are quick and the reader copies most of the time. (A reader that does not check the slot again fails in
// some runs, not in all.)
TEST(SimSource, AFrameThatChangesWhileItIsCopiedIsNotGiven) {
  constexpr std::uint32_t kSide_px = 512;
  const std::string name = own_name("interrupted");
  SimChannelWriter writer(name, kSide_px, kSide_px);
  std::atomic<bool> done{false};
  std::jthread producer([&] {
    for (std::uint64_t sequence = 1; !done; ++sequence) {
      const WritableFrame frame = writer.writable();
      *frame.header = {.sequence = sequence, .width_px = kSide_px, .height_px = kSide_px};
      std::memset(frame.grey, static_cast<int>(sequence % 251), std::size_t{kSide_px} * frame.stride_bytes);
      writer.publish();
    }
  });
  std::jthread([&] {
    stay_on_this_processor();
    std::jthread other([&] {
      while (!done) {
      }
    });
    SimSource source(name);
    EXPECT_EQ(source.open(), OpenResult::Opened);
    FrameView frame;
    int given = 0, torn = 0;
    for (const TimeNs end_ns = monotonic_now_ns() + 2 * kNsPerS; monotonic_now_ns() < end_ns;) {
      if (source.wait_frame(kNsPerS, frame) != FrameResult::Frame) continue;
      const std::span<const std::uint8_t> pixels(frame.grey, std::size_t{kSide_px} * frame.stride_bytes);
      const auto grey = static_cast<std::uint8_t>(frame.header.sequence % 251);
      torn += std::any_of(pixels.begin(), pixels.end(), [&](std::uint8_t pixel) { return pixel != grey; });
      ++given;
    }
    EXPECT_EQ(torn, 0) << "of " << given;
    EXPECT_GT(given, 0);
    done = true;
  }).join();
}

}  // namespace
}  // namespace heel
