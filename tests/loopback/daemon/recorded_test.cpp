// Recordings of heeld in real time: a run replays to the bit, holds the bytes of the wire, and outlives a
// kill.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "loopback/daemon/operated_heeld.h"
#include "recording/recording_reader.h"
#include "replay/control_replay.h"
#include "replay/vision_replay.h"

namespace heel {
namespace {

using test::eventually;
using test::monotonic_s;
using test::read_text;
using test::SocketClient;
using ::testing::HasSubstr;

using RecordedHeeld = test::OperatedHeeldFixture;

/// Everything of a recording that its run can be told from.
struct RecordedRun final : RecordingVisitor {
  void on_tick(const TickRecord& tick) override {
    newest_configuration = tick.configuration;
    t_last_tick_ns = tick.input.now_ns;
    newest_tick = tick.tick;
    ++ticks;
  }
  void on_wire(const WireBytes& wire) override {
    if (wire.to_robot) to_robot.append(reinterpret_cast<const char*>(wire.bytes.data()), wire.count);
    from_robot += wire.to_robot ? 0 : wire.count;
  }
  void on_operator(const OperatorLine& line) override {
    operators.push_back(line.request + ": " + line.answer);
  }
  void on_note(const RecordingNote& note) override { notes.push_back(note.kind + ": " + note.text); }

  std::uint64_t newest_configuration = 0, ticks = 0, newest_tick = 0;
  TimeNs t_last_tick_ns = 0;
  std::string to_robot;
  std::size_t from_robot = 0;
  std::vector<std::string> operators, notes;
};

std::string hex_of(const std::string& bytes) {
  std::string hex;
  for (const char byte : bytes) {
    const auto value = static_cast<unsigned char>(byte);
    hex += "0123456789abcdef"[value >> 4];
    hex += "0123456789abcdef"[value & 15];
  }
  return hex;
}

/// Its lines are "SECONDS HEX".
std::string hex_of_wire_file(const std::string& path) {
  std::istringstream words(read_text(path));
  std::string all;
  for (std::string t_s, hex; words >> t_s >> hex;) all += hex;
  return all;
}

TEST_F(RecordedHeeld, ARecordedRunReplaysToTheBitAndHoldsTheBytesOfTheWire) {
  get_ready(operated_config("[telemetry]\ndirectory = \"run\"\npictures = \"lossless\"\nblack_box = \"\"\n"));
  SocketClient client(socket());
  ASSERT_TRUE(drives_after_start(client)) << logs();
  ASSERT_EQ(ask(client, R"({"do":"set","values":{"gate.v_max_m_s":0.2,"control.gain_yaw_1_s":0.9}})")["ok"],
            true);
  ASSERT_EQ(ask(client, R"({"do":"mark","text":"slower now"})")["ok"], true);
  ASSERT_TRUE(eventually([&] { return speed() < 0.25; })) << logs();
  command(client, "stop");
  ASSERT_TRUE(comes_to_rest());
  daemon_->signal(SIGTERM);
  ASSERT_EQ(daemon_->wait(), 0) << logs();
  robot_->signal(SIGTERM);
  ASSERT_EQ(robot_->wait(), 0) << logs();

  const std::string recording = recording_in(scene_.path("run"));
  const ReplayResult replay = replay_control(recording, {});
  EXPECT_TRUE(replay.all_same()) << replay.same << " of " << replay.ticks << replay.ended;
  EXPECT_GT(replay.ticks, 100u);
  EXPECT_TRUE(replay.report.complete);
  RecordedRun run;
  read_recording(recording, run);
  EXPECT_EQ(run.newest_configuration, 1u) << "the set";
  EXPECT_THAT(run.operators,
              testing::IsSupersetOf({HasSubstr("start: "), HasSubstr("gate.v_max_m_s: 0.7 -> 0.2"),
                                     HasSubstr("mark: done"), HasSubstr("stop: done")}));
  EXPECT_THAT(run.notes, testing::ElementsAre("begin: heeld", "mark: slower now", "end: heeld stopped"));
  // What the simulator read is what heeld recorded as written.
  EXPECT_EQ(hex_of(run.to_robot), hex_of_wire_file(scene_.path("wire.hex")));
  EXPECT_GT(run.from_robot, 500u);
  const VisionReplayResult vision = replay_vision(recording);
  EXPECT_TRUE(vision.all_same()) << vision.same << " of " << vision.frames;
  // On a busy machine a picture may be dropped: the replay ends there.
  EXPECT_GT(vision.frames, 3u) << vision.ended;
}

TEST_F(RecordedHeeld, AKilledHeeldLeavesItsLastTicksAndTheRecording) {
  const std::string config = operated_config("[telemetry]\ndirectory = \"run\"\nblack_box = \"black-box\"\n");
  get_ready(config);
  SocketClient client(socket());
  ASSERT_TRUE(drives_after_start(client)) << logs();
  daemon_->signal(SIGKILL);
  daemon_->wait();
  const double t_killed_s = monotonic_s();
  const std::string cut = recording_in(scene_.path("run"));
  RecordedRun run;
  const RecordingReport report = read_recording(cut, run);
  EXPECT_FALSE(report.complete);
  EXPECT_GT(run.ticks, 20u);

  start_heeld(config);
  ASSERT_TRUE(daemon_->says("did not end by itself: its last 30 s are in")) << logs();
  daemon_->signal(SIGTERM);
  ASSERT_EQ(daemon_->wait(), 0) << logs();
  std::string left;
  for (const auto& entry : std::filesystem::directory_iterator(scene_.path("run")))
    if (entry.path().string().ends_with("-black-box.mcap")) left = entry.path().string();
  ASSERT_NE(left, "");
  RecordedRun last;
  EXPECT_TRUE(read_recording(left, last).complete);
  EXPECT_GE(last.newest_tick, run.newest_tick) << "it has what no chunk had yet";
  EXPECT_LT(t_killed_s - seconds_from_ns(last.t_last_tick_ns), 1.0);
  const bool whole_run = last.newest_tick + 1 == last.ticks;
  if (whole_run) {
    EXPECT_TRUE(replay_control(left, {}).all_same());
  } else {
    EXPECT_EQ(last.ticks, 1536u) << "30 s of a run that took longer on a busy machine";
  }
}

}  // namespace
}  // namespace heel
