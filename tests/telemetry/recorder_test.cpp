// Recordings on disk: every kind of record comes back, earlier recordings are kept, and a full disk does not
// end the recording.
#include "telemetry/recorder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "mcap/mcap_reader.h"
#include "recording/recording_reader.h"
#include "support/collected_log.h"
#include "support/complaint.h"
#include "support/temporary_folder.h"
#include "telemetry/small_disk.h"

namespace heel {
namespace {

using test::read_text;
using testing::HasSubstr;

/// Everything of a recording.
class All final : public RecordingVisitor {
 public:
  void on_tick(const TickRecord& tick) override { ticks.push_back(tick); }
  void on_pose(const PoseEstimate& pose) override { poses.push_back(pose); }
  void on_capture(const CaptureCounters& counters) override { captures.push_back(counters); }
  void on_event(const Event& event) override { events.push_back(event); }
  void on_wire(const WireBytes& bytes) override { wire.push_back(bytes); }
  void on_log(const LogLine& line) override { log.push_back(line); }
  void on_configuration(const ConfigurationText& text) override { configurations.push_back(text); }
  void on_operator(const OperatorLine& line) override { operators.push_back(line); }
  void on_note(const RecordingNote& note) override { notes.push_back(note); }

  std::vector<TickRecord> ticks;
  std::vector<PoseEstimate> poses;
  std::vector<CaptureCounters> captures;
  std::vector<Event> events;
  std::vector<WireBytes> wire;
  std::vector<LogLine> log;
  std::vector<ConfigurationText> configurations;
  std::vector<OperatorLine> operators;
  std::vector<RecordingNote> notes;
};

TEST(Recorder, KeepsRecordsOfEachKind) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("run.mcap");
  {
    Recorder recorder(path, RecordingClock{});
    TickRecord tick;
    tick.input.now_ns = 1'500'000'000;
    tick.person_m = std::numeric_limits<double>::infinity();
    recorder.record(tick);
    PoseEstimate pose;
    pose.frame_sequence = 42;
    recorder.record(pose);
    recorder.record(CaptureCounters{.t_ns = 2'000'000'000, .captured = 11});
    Event event;
    event.t_ns = 3'000'000'000;
    event.kind = EventKind::FrameRefused;
    event.a = -320;
    recorder.record(event);
    const std::vector<std::uint8_t> bytes(300, 0xfa);
    recorder.record_wire(bytes, /*to_robot=*/true, 5);
    recorder.record_text(6, "at rest: \"quoted\"\n");
    recorder.record(ConfigurationText{7, 1, "[gate]\n"});
    recorder.record(OperatorLine{8, "pid 3", "set", "done"});
    recorder.record(RecordingNote{9, "lost", "records lost", 12});
  }
  All all;
  const RecordingReport report = read_recording(path, all);
  EXPECT_TRUE(report.complete);
  EXPECT_THAT(report.problems, testing::IsEmpty());
  EXPECT_THAT(report.other_version, testing::IsEmpty());
  ASSERT_EQ(all.ticks.size(), 1u);
  EXPECT_EQ(all.ticks[0].input.now_ns, 1'500'000'000);
  EXPECT_EQ(all.ticks[0].person_m, std::numeric_limits<double>::infinity());
  ASSERT_EQ(all.poses.size(), 1u);
  EXPECT_EQ(all.poses[0].frame_sequence, 42u);
  ASSERT_EQ(all.captures.size(), 1u);
  EXPECT_EQ(all.captures[0], (CaptureCounters{.t_ns = 2'000'000'000, .captured = 11}));
  ASSERT_EQ(all.events.size(), 1u);
  EXPECT_EQ(all.events[0].kind, EventKind::FrameRefused);
  EXPECT_EQ(all.events[0].a, -320);
  ASSERT_EQ(all.wire.size(), 3u) << "118, 118 and 64 bytes";
  EXPECT_EQ(all.wire[2].count, 64);
  EXPECT_EQ(all.wire[2].bytes[63], 0xfa);
  EXPECT_TRUE(all.wire[2].to_robot);
  ASSERT_EQ(all.log.size(), 1u);
  EXPECT_EQ(all.log[0].text, "at rest: \"quoted\"\n");
  ASSERT_EQ(all.configurations.size(), 1u);
  EXPECT_EQ(all.configurations[0].number, 1u);
  ASSERT_EQ(all.operators.size(), 1u);
  EXPECT_EQ(all.operators[0].who, "pid 3");
  ASSERT_EQ(all.notes.size(), 1u);
  EXPECT_EQ(all.notes[0].lost, 12u);
}

TEST(Recorder, ViewersGetTheRobotAndThePersonEveryFifthTick) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("run.mcap");
  {
    Recorder recorder(path, RecordingClock{2 * kNsPerS});
    TickRecord tick;
    tick.input.now_ns = 1'500'000'000;
    tick.input.robot.has_sip = true;
    tick.input.robot.odometry.x_m = 3.5;
    tick.target.known = true;
    tick.target.y_m = -0.25;
    tick.target.travel_yaw_rad = 3.141592653589793;
    for (tick.tick = 0; tick.tick < 10; ++tick.tick) recorder.record(tick);
    tick.input.robot.has_sip = tick.target.known = false;
    for (; tick.tick < 20; ++tick.tick) recorder.record(tick);
  }
  std::map<std::string, std::vector<std::string>> messages;
  std::ifstream file(path, std::ios::binary);
  McapReader reader(file, path);
  for (McapMessage message; reader.next(message);)
    messages[reader.channel(message.channel).topic].emplace_back(message.data);
  ASSERT_EQ(messages["/tf"].size(), 2u);
  EXPECT_THAT(messages["/tf"][0],
              HasSubstr(R"({"timestamp":{"sec":3,"nsec":500000000},"parent_frame_id":"odom")"));
  EXPECT_THAT(messages["/tf"][0], HasSubstr(R"("translation":{"x":3.5,)"));
  ASSERT_EQ(messages["/person"].size(), 2u);
  EXPECT_THAT(messages["/person"][0],
              HasSubstr(R"("frame_id":"robot","pose":{"position":{"x":0,"y":-0.25,"z":0})"));
  EXPECT_THAT(messages["/person"][0], HasSubstr(R"("z":1,"w":6.1)")) << "half a turn";
}

TEST(Recorder, WhatWasFlushedIsThereWithoutTheEnd) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("run.mcap");
  Recorder recorder(path, RecordingClock{});
  TickRecord tick;
  for (tick.tick = 0; tick.tick < 60; ++tick.tick) {
    recorder.record(tick);
    if (tick.tick == 49) recorder.flush();
  }
  const std::string until_now = read_text(path);  // as after a power cut
  for (const std::size_t cut : {std::size_t{0}, std::size_t{1}, std::size_t{500}}) {
    const std::string cut_path =
        test::write_text(folder.file("cut.mcap"), until_now.substr(0, until_now.size() - cut));
    All all;
    const RecordingReport report = read_recording(cut_path, all);
    EXPECT_FALSE(report.complete);
    ASSERT_EQ(report.problems.size(), 1u);
    // The index of the chunk stands behind it.
    EXPECT_EQ(all.ticks.size(), cut < 500 ? 50u : all.ticks.size());
    EXPECT_THAT(report.problems[0], HasSubstr("messages before it were read"));
    EXPECT_THAT(report.problems[0], HasSubstr(cut_path + ": byte "));
  }
}

TEST(Recorder, AFullDiskLosesWholeChunksAndCountsTheirMessages) {
  const test::TemporaryFolder folder;
  const test::CollectedLog log;
  const std::string path = folder.file("run.mcap");
  std::uint64_t lost = 0;
  std::uint64_t written = 0;
  {
    Recorder recorder(path, RecordingClock{});
    // Texts that do not compress: more than the file keeps in memory.
    std::mt19937 random(7);
    std::string text(20'000, ' ');
    {
      const test::SmallDisk disk(std::filesystem::file_size(path) + 100);
      for (int i = 0; i < 600; ++i) {
        for (char& letter : text) letter = static_cast<char>('!' + random() % 90);
        recorder.record_text(i, text);
        recorder.flush();
      }
      EXPECT_EQ(log.count("cannot write: "), 1) << log.text();
    }
    lost = recorder.records_lost();
    EXPECT_GT(lost, 100u);
    recorder.record_text(1000, "after");
    recorder.flush();
    written = recorder.messages();
  }
  EXPECT_EQ(lost + written, 601u);
  All all;
  const RecordingReport report = read_recording(path, all);
  EXPECT_TRUE(report.complete);
  EXPECT_THAT(report.problems, testing::IsEmpty());
  EXPECT_EQ(all.log.size(), written);
  EXPECT_EQ(all.log.back().text, "after");
}

TEST(Recorder, AnEarlierRecordingIsNeverOverwritten) {
  const test::TemporaryFolder folder;
  const std::string directory = folder.file("a/new/folder");
  const std::string first = new_recording_path(directory);
  { const Recorder recorder(first, RecordingClock::wall()); }
  const std::string second = new_recording_path(directory);
  EXPECT_NE(first, second);
  { const Recorder recorder(second, RecordingClock::wall()); }
  EXPECT_THAT(first, testing::MatchesRegex(".*/heel-20[0-9T]+Z\\.mcap"));
  EXPECT_THAT(test::complaint_of([&] { const Recorder recorder(first, RecordingClock{}); }),
              HasSubstr(first));
}

TEST(Recorder, AFolderThatCannotBeMadeIsNamed) {
  const test::TemporaryFolder folder;
  const std::string file = test::write_text(folder.file("file"), "not a folder");
  EXPECT_THAT(test::complaint_of([&] { new_recording_path(file + "/run"); }),
              HasSubstr("telemetry.directory " + file + "/run"));
}

}  // namespace
}  // namespace heel
