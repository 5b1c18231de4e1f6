// Pictures in a recording: as configured, and those of the last 30 s with a fault.
#include "telemetry/picture_recorder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "recording/recording_reader.h"
#include "support/collected_log.h"
#include "support/temporary_folder.h"
#include "telemetry/recording_folder.h"
#include "telemetry/telemetry.h"

namespace heel {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr std::uint32_t kWidth_px = 32, kHeight_px = 24;

/// A ramp, a little brighter with each frame.
std::vector<std::uint8_t> ramp(std::uint64_t sequence) {
  std::vector<std::uint8_t> grey(kWidth_px * kHeight_px);
  for (std::size_t i = 0; i < grey.size(); ++i) grey[i] = static_cast<std::uint8_t>(i / 8 + sequence);
  return grey;
}

class Pictures : public testing::Test, public RecordingVisitor {
 protected:
  void push(std::uint64_t sequence, TimeNs t_ns) {
    const std::vector<std::uint8_t> grey = ramp(sequence);
    ASSERT_TRUE(queue_.push({{sequence, t_ns, kWidth_px, kHeight_px}, grey.data(), kWidth_px}));
  }
  void on_picture(const RecordedPicture& picture) override {
    numbers_.push_back(picture.header.sequence);
    pictures_.push_back(picture);
  }
  void read() { read_recording(recording_in(folder_.path().string()), *this); }

  const test::TemporaryFolder folder_;
  test::CollectedLog log_;
  PictureQueue queue_{16, kWidth_px, kHeight_px};
  std::vector<std::uint64_t> numbers_;
  std::vector<RecordedPicture> pictures_;
};

TEST_F(Pictures, LosslessOnesComeBackToTheBitAndJpegsNearly) {
  for (const bool lossless : {true, false}) {
    const std::string path = folder_.file(lossless ? "a.mcap" : "b.mcap");
    {
      Recorder recorder(path, RecordingClock{});
      PictureRecorder pictures(&queue_, lossless ? "lossless" : "jpeg");
      push(7, 5);
      pictures.drain(recorder);
    }
    pictures_.clear();
    read_recording(path, *this);
    ASSERT_EQ(pictures_.size(), 1u);
    EXPECT_EQ(pictures_[0].header.sequence, 7u);
    EXPECT_EQ(pictures_[0].header.t_capture_ns, 5);
    const std::vector<std::uint8_t> pixels = picture_pixels(pictures_[0]), written = ramp(7);
    ASSERT_EQ(pixels.size(), written.size());
    int largest = 0;
    for (std::size_t i = 0; i < pixels.size(); ++i)
      largest = std::max(largest, std::abs(pixels[i] - written[i]));
    EXPECT_LE(largest, lossless ? 0 : 12);
  }
}

TEST_F(Pictures, OnFaultTheLast30SecondsAreWritten) {
  TelemetryQueues queues;
  Telemetry telemetry(queues, {.directory = folder_.path().string(), .pictures = "on_fault", .black_box = ""},
                      &queue_);
  TickRecord tick;
  tick.state = SupervisorState::Following;
  const auto drain = [&] {
    queues.ticks.push(tick);
    telemetry.drain(kNsPerS);
  };
  for (std::uint64_t i = 0; i < 50; ++i) {
    push(i, static_cast<TimeNs>(i) * kNsPerS);
    drain();
  }
  tick.state = SupervisorState::Stopped;
  drain();
  drain();
  push(50, 50 * kNsPerS);
  drain();
  EXPECT_TRUE(telemetry.mark("look"));
  drain();
  push(51, 51 * kNsPerS);
  drain();
  telemetry.stop();
  telemetry.run();
  read();
  ASSERT_EQ(numbers_.size(), 32u) << "19 to 49 with the fault, 50 with the mark";
  EXPECT_EQ(numbers_.front(), 19u);
  EXPECT_EQ(numbers_.back(), 50u);
}

// The camera brings a new frame while each one is compressed, for ever.
TEST_F(Pictures, ASlowEncoderDelaysNeitherTheRecordsNorTheEnd) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(5);
  std::uint64_t frames = 1;
  const auto encoder = [&](const FrameView& frame, bool lossless) {
    std::this_thread::sleep_for(std::chrono::milliseconds(15));
    if (std::chrono::steady_clock::now() < end) {
      push(frames, static_cast<TimeNs>(frames));
      ++frames;
    }
    return compressed_picture(frame, lossless);
  };
  TelemetryQueues queues;
  Telemetry telemetry(queues, {.directory = folder_.path().string(), .pictures = "jpeg", .black_box = ""},
                      &queue_, encoder);
  push(0, 0);
  const auto begin = std::chrono::steady_clock::now();
  for (std::uint64_t tick = 0; tick < 3; ++tick) {
    queues.ticks.push(TickRecord{});
    telemetry.drain(kNsPerS);
    EXPECT_EQ(telemetry.snapshot().ticks, tick + 1);
  }
  telemetry.stop();
  telemetry.run();
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(3));
  read();
  EXPECT_GE(numbers_.size(), 3u) << "one in each drain at least";
}

TEST_F(Pictures, AfterTheEndByKeepMbNothingIsLostAndMarksAreRefused) {
  TelemetryQueues queues;
  Telemetry telemetry(
      queues, {.directory = folder_.path().string(), .pictures = "jpeg", .keep_mb = 0.001, .black_box = ""},
      &queue_);
  EXPECT_EQ(log_.count("ends here: it needs more than telemetry.keep_mb"), 1) << log_.text();
  push(0, 0);
  for (std::uint64_t i = 1; i < 40; ++i) {
    telemetry.drain(static_cast<TimeNs>(i + 2) * kNsPerS);
    const std::vector<std::uint8_t> grey = ramp(i);
    EXPECT_FALSE(queue_.push({{i, static_cast<TimeNs>(i), kWidth_px, kHeight_px}, grey.data(), kWidth_px}))
        << "nobody wants it any more";
  }
  EXPECT_FALSE(telemetry.mark("look"));
  EXPECT_EQ(telemetry.snapshot().records_lost, 0u);
  EXPECT_EQ(log_.count("too slow"), 0) << log_.text();
}

/// Looks at pictures while the test says so.
class Looker final : public TelemetryListener {
 public:
  void tick(const TickRecord&) override { ++ticks; }
  void pose(const PoseEstimate&) override { ++poses; }
  void event(const Event&) override { ++events; }
  bool wants_pictures() override { return wants; }
  void picture(const FrameView& frame) override { seen.push_back(frame.header.sequence); }

  bool wants = false;
  int ticks = 0, poses = 0, events = 0;
  std::vector<std::uint64_t> seen;
};

TEST_F(Pictures, AListenerSeesThemWithoutARecordingAndOnlyWhileItWantsThem) {
  TelemetryQueues queues;
  Telemetry telemetry(queues, {.directory = "", .pictures = "none", .black_box = ""}, &queue_);
  Looker looker;
  telemetry.listen(looker);
  telemetry.drain(kNsPerS);
  const std::vector<std::uint8_t> grey = ramp(0);
  EXPECT_FALSE(queue_.push({{1, 1, kWidth_px, kHeight_px}, grey.data(), kWidth_px})) << "nobody looks";
  looker.wants = true;
  telemetry.drain(2 * kNsPerS);
  push(2, 2);
  push(3, 3);
  queues.ticks.push({});
  queues.poses.push({});
  queues.control_events.push({});
  telemetry.drain(3 * kNsPerS);
  EXPECT_THAT(looker.seen, testing::ElementsAre(2u, 3u));
  EXPECT_EQ(looker.ticks, 1);
  EXPECT_EQ(looker.poses, 1);
  EXPECT_EQ(looker.events, 1);
  EXPECT_EQ(telemetry.snapshot().records_lost, 0u);
}

TEST_F(Pictures, AListenerSeesWhatIsRecordedAndARecordingWithoutPicturesHasNone) {
  for (const bool recorded : {true, false}) {
    const test::TemporaryFolder folder;
    Looker looker;
    looker.wants = true;
    {
      TelemetryQueues queues;
      Telemetry telemetry(
          queues,
          {.directory = folder.path().string(), .pictures = recorded ? "jpeg" : "none", .black_box = ""},
          &queue_);
      telemetry.listen(looker);
      telemetry.drain(kNsPerS);
      push(7, 7);
      telemetry.drain(2 * kNsPerS);
    }
    numbers_.clear();
    read_recording(recording_in(folder.path().string()), *this);
    EXPECT_THAT(looker.seen, testing::ElementsAre(7u));
    EXPECT_EQ(numbers_.size(), recorded ? 1u : 0u);
  }
}

TEST_F(Pictures, WithoutPicturesNothingIsWritten) {
  {
    Recorder recorder(folder_.file("a.mcap"), RecordingClock{});
    PictureRecorder pictures(nullptr, "none");
    pictures.drain(recorder);
    pictures.write_kept(recorder);
  }
  read();
  EXPECT_THAT(numbers_, IsEmpty());
}

class KeptRecordings : public testing::Test {
 protected:
  /// `age_s` old, with this many bytes.
  void write(const std::string& name, std::size_t bytes, double age_s) {
    const std::string path = test::write_text(folder_.file(name), std::string(bytes, 'x'));
    std::filesystem::last_write_time(
        path, std::filesystem::file_time_type::clock::now() - std::chrono::seconds(static_cast<int>(age_s)));
  }
  std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
      all.push_back(entry.path().filename().string());
    std::sort(all.begin(), all.end());
    return all;
  }
  const test::TemporaryFolder folder_;
  const test::CollectedLog log_;
};

TEST_F(KeptRecordings, TheOldestGoUntilSizeAndAgeFit) {
  write("heel-1.mcap", 1000, 500);
  write("heel-2.mcap", 1000, 400);
  write("heel-3.mcap", 1000, 300);
  write("heel-4.mcap", 1000, 0);
  write("heel-1.txt", 5000, 900);
  write("mine.mcap", 5000, 900);
  const std::string folder = folder_.path().string();
  EXPECT_EQ(remove_old_recordings(folder, folder + "/heel-4.mcap", {10'000, 450 * kNsPerS}), 3000u);
  EXPECT_THAT(names(), ElementsAre("heel-1.txt", "heel-2.mcap", "heel-3.mcap", "heel-4.mcap", "mine.mcap"));
  EXPECT_EQ(log_.count("heel-1.mcap removed: older than telemetry.keep_days"), 1) << log_.text();
  EXPECT_EQ(remove_old_recordings(folder, folder + "/heel-4.mcap", {2500, 450 * kNsPerS}), 2000u);
  EXPECT_EQ(log_.count("heel-2.mcap removed: more than telemetry.keep_mb"), 1) << log_.text();
  EXPECT_EQ(remove_old_recordings(folder, folder + "/heel-4.mcap", {500, 0}), 1000u)
      << "the current one stays";
  EXPECT_THAT(names(), ElementsAre("heel-1.txt", "heel-4.mcap", "mine.mcap"));
}

}  // namespace
}  // namespace heel
