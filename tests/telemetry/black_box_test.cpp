// What outlives a heeld that did not end by itself.
#include "telemetry/black_box.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "recording/recording_reader.h"
#include "support/collected_log.h"
#include "support/complaint.h"
#include "support/temporary_folder.h"
#include "telemetry/small_disk.h"
#include "telemetry/telemetry.h"

namespace heel {
namespace {

using testing::HasSubstr;

struct LeftBehind final : RecordingVisitor {
  void on_tick(const TickRecord& tick) override { ticks.push_back(tick.tick); }
  void on_pose(const PoseEstimate& pose) override { poses.push_back(pose.frame_sequence); }
  void on_event(const Event& event) override { events.push_back(event.text.data()); }
  void on_wire(const WireBytes& bytes) override { wire += bytes.count; }
  void on_configuration(const ConfigurationText& text) override { configuration = text.text; }
  std::vector<std::uint64_t> ticks, poses;
  std::vector<std::string> events;
  std::size_t wire = 0;
  std::string configuration;
};

class BlackBoxTest : public testing::Test {
 protected:
  LeftBehind recovered() {
    LeftBehind left;
    EXPECT_TRUE(recover_black_box(box_, recording_));
    read_recording(recording_, left);
    return left;
  }
  const test::TemporaryFolder folder_;
  const std::string box_ = folder_.file("black-box"), recording_ = folder_.file("left.mcap");
};

TEST_F(BlackBoxTest, KeepsTheLast30SecondsOfARunThatDidNotEnd) {
  {
    BlackBox box(box_, RecordingClock{});
    box.add(ConfigurationText{1, 0, "[gate]\n"});
    TickRecord tick;
    for (tick.tick = 0; tick.tick < 2000; ++tick.tick) box.add(tick);
    PoseEstimate pose;
    pose.frame_sequence = 7;
    box.add(pose);
    Event event;
    event.text = {'g', 'o', 'n', 'e'};
    box.add(event);
    box.add(WireBytes{.count = 5});
    EXPECT_FALSE(recover_black_box(box_, recording_)) << "a heeld has it";
    EXPECT_THAT(test::complaint_of([&] { const BlackBox second(box_, RecordingClock{}); }),
                HasSubstr("another heeld uses it"));
  }
  const LeftBehind left = recovered();
  ASSERT_EQ(left.ticks.size(), 1535u) << "the oldest of 1536 may be half replaced";
  EXPECT_EQ(left.ticks.front(), 2000u - 1535u);
  EXPECT_EQ(left.ticks.back(), 1999u);
  EXPECT_THAT(left.poses, testing::ElementsAre(7u));
  EXPECT_THAT(left.events, testing::ElementsAre("gone"));
  EXPECT_EQ(left.wire, 5u);
  EXPECT_EQ(left.configuration, "[gate]\n");
}

TEST_F(BlackBoxTest, ARunThatEndedLeavesNothing) {
  {
    BlackBox box(box_, RecordingClock{});
    box.add(TickRecord{});
    box.end();
  }
  EXPECT_FALSE(recover_black_box(box_, recording_));
  EXPECT_FALSE(std::filesystem::exists(recording_));
  EXPECT_FALSE(recover_black_box(folder_.file("none"), recording_));
  test::write_text(box_, "something else");
  EXPECT_FALSE(recover_black_box(box_, recording_));
}

TEST_F(BlackBoxTest, AFullRingLeavesOutTheRecordThatTheNextOneReplaces) {
  for (const std::uint64_t ticks : {1535u, 1536u, 1537u}) {
    {
      BlackBox box(box_, RecordingClock{});
      TickRecord tick;
      for (tick.tick = 0; tick.tick < ticks; ++tick.tick) box.add(tick);
    }
    const LeftBehind left = recovered();
    EXPECT_EQ(left.ticks.front(), ticks - 1535);
    EXPECT_EQ(left.ticks.size(), 1535u);
  }
}

TEST_F(BlackBoxTest, AFileOfAnotherKindIsNotOverwritten) {
  for (const std::string content : {"my thesis, the only copy", "HEEL"}) {
    test::write_text(box_, content);
    EXPECT_THAT(
        test::complaint_of([&] { const BlackBox box(box_, RecordingClock{}); }),
        HasSubstr("black-box: another file has this name (expected none, an empty one or a black box"));
    EXPECT_EQ(test::read_text(box_), content);
  }
  for (const std::string content : {"", "HEELBOX0 of an earlier version"}) {
    test::write_text(box_, content);
    const BlackBox box(box_, RecordingClock{});
  }
}

TEST_F(BlackBoxTest, TheCauseIsNamedWhenThereIsNoRoomForIt) {
  const test::SmallDisk disk(1000);
  EXPECT_THAT(test::complaint_of([&] { const BlackBox box(box_, RecordingClock{}); }),
              HasSubstr("black-box: cannot be made: File too large"));
}

TEST_F(BlackBoxTest, OneOfAnotherBuildIsNamed) {
  {
    BlackBox box(box_, RecordingClock{});
    box.add(TickRecord{});
  }
  std::string bytes = test::read_text(box_);
  bytes[9] = static_cast<char>(bytes[9] + 1);  // of the layout's sum
  test::write_text(box_, bytes);
  EXPECT_THAT(test::complaint_of([&] { recover_black_box(box_, recording_); }),
              HasSubstr("another build of heel"));
}

TEST_F(BlackBoxTest, TheNextStartMakesARecordingOfIt) {
  const test::CollectedLog log;
  const TelemetryConfig config{.directory = folder_.file("run"), .black_box = box_};
  {
    TelemetryQueues queues;
    Telemetry telemetry(queues, config);
    queues.ticks.push(TickRecord{});
    telemetry.drain(kNsPerS);
    // It does not come to run(), as after a crash.
  }
  {
    TelemetryQueues queues;
    Telemetry telemetry(queues, config);
    EXPECT_EQ(log.count("the last run of heeld did not end by itself: its last 30 s are in"), 1)
        << log.text();
    telemetry.stop();
    telemetry.run();
  }
  int black_boxes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder_.file("run")))
    black_boxes += entry.path().filename().string().ends_with("-black-box.mcap");
  EXPECT_EQ(black_boxes, 1);
  TelemetryQueues queues;
  const Telemetry third(queues, config);
  EXPECT_EQ(log.count("did not end by itself"), 1) << "the second one did";
}

TEST_F(BlackBoxTest, OneThatCannotBeSavedIsKeptUnderAnotherName) {
  const test::CollectedLog log;
  {
    BlackBox box(box_, RecordingClock{});
    TickRecord tick;
    for (tick.tick = 0; tick.tick < 100; ++tick.tick) box.add(tick);
    const test::SmallDisk disk(1000);
    EXPECT_THAT(test::complaint_of([&] { box.save(recording_); }),
                HasSubstr("left.mcap: the black box could not"));
  }
  {
    const test::SmallDisk disk(1000);
    TelemetryQueues queues;
    const Telemetry telemetry(queues, {.directory = "", .black_box = box_});
    EXPECT_EQ(log.count("did not end by itself"), 0) << log.text();
    EXPECT_EQ(log.count("the black box of the last run is kept as " + box_ + ".kept"), 1) << log.text();
  }
  EXPECT_FALSE(std::filesystem::exists(box_ + ".mcap")) << "a part of it";
  std::filesystem::rename(box_ + ".kept", box_);
  EXPECT_EQ(recovered().ticks.size(), 100u);
}

TEST_F(BlackBoxTest, AFaultSavesItWhereNothingIsRecorded) {
  const test::CollectedLog log;
  TelemetryQueues queues;
  Telemetry telemetry(queues, {.directory = "", .black_box = box_});
  TickRecord tick;
  tick.state = SupervisorState::Following;
  queues.ticks.push(tick);
  tick.state = SupervisorState::Emergency;
  tick.tick = 1;
  queues.ticks.push(tick);
  telemetry.drain(kNsPerS);
  LeftBehind left;
  read_recording(box_ + "-fault.mcap", left);
  EXPECT_EQ(left.ticks.size(), 2u);
}

TEST_F(BlackBoxTest, WithoutAPlaceForItHeeldGoesOn) {
  const test::CollectedLog log;
  TelemetryQueues queues;
  Telemetry telemetry(queues, {.directory = "", .black_box = folder_.file("no/such/folder/box")});
  EXPECT_EQ(log.count("[info] no black box: telemetry.black_box "), 1) << log.text();
  EXPECT_EQ(log.count("/no/such/folder/box: its folder is missing"), 1) << log.text();
  telemetry.drain(kNsPerS);
}

}  // namespace
}  // namespace heel
