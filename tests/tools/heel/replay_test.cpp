// heel replay and heel export: a recording of the lock step through the same code is the same to the bit;
// what differs, and what cannot be read, is named.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "recording/bundle.h"
#include "recording/recording_reader.h"
#include "support/test_data.h"
#include "telemetry/recorder.h"
#include "tools/heel/refusals.h"
#include "tools/heel/run_heel.h"

namespace heel {
namespace {

using test::Outcome;
using test::run_heel;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// Six seconds without pictures, in which the robot follows.
class Replay : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    static const test::TemporaryFolder folder;
    const std::string scenario =
        test::write_text(folder.file("walk.toml"),
                         "name = \"walk\"\nduration_s = 6.0\n[person]\nwalk_after_s = 0.0\n"
                         "[[person.path]]\nstep = \"straight\"\nlength_m = 5\n[robot]\nx_m = -1.8\n");
    const Outcome run =
        run_heel({"simulate", scenario, "--error-model",
                  test::source_path("tools/heel-sim/pose_noise/pictured.toml"), "--out", folder.file("run")});
    ASSERT_EQ(run.status, 0) << run.err;
    recording_ = folder.file("run/run.mcap");
  }
  /// The recording with changes: `change` says whether a tick is kept.
  template <typename Change>
  std::string changed(Change change) const {
    struct Copy final : RecordingVisitor {
      explicit Copy(const std::string& path, Change how) : recorder(path, RecordingClock{}), change(how) {}
      void on_tick(const TickRecord& tick) override {
        TickRecord copy = tick;
        if (change(copy)) recorder.record(copy);
      }
      void on_configuration(const ConfigurationText& text) override { recorder.record(text); }
      Recorder recorder;
      Change change;
    };
    const std::string path = folder_.file("changed.mcap");
    std::filesystem::remove(path);
    Copy copy(path, change);
    read_recording(recording_, copy);
    return path;
  }

  static inline std::string recording_;
  const test::TemporaryFolder folder_;
};

TEST_F(Replay, NothingHasChanged) {
  const Outcome replay = run_heel({"replay", recording_});
  EXPECT_EQ(replay.status, 0) << replay.err;
  EXPECT_EQ(replay.out,
            "301 of 301 ticks the same (6.0 s)\nvision is not replayed: the recording has no pictures\n");
  EXPECT_EQ(replay.err, "");
}

TEST_F(Replay, WhatDiffersIsNamed) {
  const std::string path = changed([](TickRecord& tick) {
    if (tick.tick >= 200) tick.target.x_m += 0.25;
    if (tick.tick == 250) tick.command.v_m_s = 0.125;
    return true;
  });
  const Outcome replay = run_heel({"replay", path, "--diff"});
  EXPECT_EQ(replay.status, 1) << replay.err;
  EXPECT_THAT(replay.out,
              AllOf(StartsWith("200 of 301 ticks the same (6.0 s)\nfirst difference: tick 200, 4.000 s "
                               "after the first\n  target.x_m "),
                    HasSubstr("\ncommand.v_m_s "), HasSubstr("\ntarget.x_m ")));
  EXPECT_THAT(replay.out, testing::ContainsRegex("target.x_m +101 +200  0.25"));
  EXPECT_THAT(replay.out, testing::ContainsRegex("command.v_m_s +1 +250  0"));
}

TEST_F(Replay, AnotherValueIsAnsweredUpToTheFirstCommandThatDiffers) {
  const Outcome slower =
      run_heel({"replay", recording_, "--set", "gate.v_max_m_s=0.25", "--plot", folder_.file("plot")});
  EXPECT_EQ(slower.status, 1) << slower.err;
  EXPECT_THAT(slower.out, AllOf(StartsWith("the commands of "), HasSubstr("command.v_m_s"),
                                HasSubstr("replayed 0.25\n"), HasSubstr("the recording cannot answer")));
  EXPECT_TRUE(std::filesystem::exists(folder_.file("plot/replay.csv")));
  const Outcome same = run_heel({"replay", recording_, "--set", "supervisor.battery_low_v=10.5"});
  EXPECT_EQ(same.status, 0) << same.out << same.err;
  EXPECT_THAT(same.out, StartsWith("all 301 commands are the same (6.0 s)"));
}

/// A second of pictures through the lock step, recorded as `pictures` says.
std::string pictured_run(const test::TemporaryFolder& folder, const std::string& pictures) {
  const std::string scenario = test::write_text(folder.file("walk.toml"),
                                                "name = \"walk\"\nduration_s = 1.0\n[person]\nwalk_after_s = "
                                                "0.0\n[[person.path]]\nstep = \"straight\"\n"
                                                "length_m = 3\n[robot]\nx_m = -1.8\n[camera]\nwidth_px = "
                                                "320\nheight_px = 240\nfocal_px = [415.0, 415.0]\n"
                                                "centre_px = [161.0, 118.0]\n");
  const std::string config =
      test::write_text(folder.file("heel.toml"), "[telemetry]\npictures = \"" + pictures + "\"\n");
  const Outcome run = run_heel({"simulate", scenario, "--config", config, "--out", folder.file("pictured")});
  EXPECT_NE(run.status, 2) << run.err;
  return folder.file("pictured/run.mcap");
}

TEST_F(Replay, LosslessPicturesRepeatVisionToTheBit) {
  const std::string recording = pictured_run(folder_, "lossless");
  const Outcome replay = run_heel({"replay", recording});
  EXPECT_EQ(replay.status, 0) << replay.err;
  EXPECT_THAT(replay.out,
              testing::ContainsRegex("^51 of 51 ticks the same .*\n(2[0-9]) of (2[0-9]) frames the same in "
                                     "vision\n$"));
  // A pose that was changed in the recording is named.
  struct Copy final : RecordingVisitor {
    explicit Copy(const std::string& path) : recorder(path, RecordingClock{}) {}
    void on_tick(const TickRecord& tick) override { recorder.record(tick); }
    void on_configuration(const ConfigurationText& text) override { recorder.record(text); }
    void on_picture(const RecordedPicture& picture) override { recorder.record(picture); }
    void on_pose(const PoseEstimate& pose) override {
      PoseEstimate copy = pose;
      if (++poses == 5) copy.certainty = 0.5;
      recorder.record(copy);
    }
    Recorder recorder;
    int poses = 0;
  };
  const std::string changed = folder_.file("changed.mcap");
  {
    Copy copy(changed);
    const RecordingReport report = read_recording(recording, copy);
    for (const auto& [name, content] : report.attachments) copy.recorder.attach(name, "", content);
  }
  const Outcome differs = run_heel({"replay", changed});
  EXPECT_EQ(differs.status, 1);
  EXPECT_THAT(differs.out, AllOf(HasSubstr("first difference in vision: frame 5\n  certainty "),
                                 HasSubstr("recorded 0.5, replayed 0.")));
}

TEST_F(Replay, JpegPicturesAreNoReplayOfVision) {
  const Outcome replay = run_heel({"replay", pictured_run(folder_, "jpeg")});
  EXPECT_EQ(replay.status, 0) << replay.err;
  EXPECT_THAT(replay.out, HasSubstr("vision is not replayed: the pictures are JPEG"));
}

TEST_F(Replay, LostTicksEndIt) {
  const Outcome gap = run_heel({"replay", changed([](TickRecord& tick) { return tick.tick != 100; })});
  EXPECT_EQ(gap.status, 1);
  EXPECT_THAT(gap.out,
              AllOf(StartsWith("100 of 100 ticks the same"),
                    HasSubstr("after tick 99 the recording goes on with tick 101: records were lost")));
}

TEST_F(Replay, ACutRecordingReplaysToItsLastWholeChunk) {
  const std::string bytes = test::read_text(recording_);
  const std::string cut = test::write_text(folder_.file("cut.mcap"), bytes.substr(0, bytes.size() / 2));
  const Outcome replay = run_heel({"replay", cut});
  EXPECT_EQ(replay.status, 0) << replay.out;
  EXPECT_THAT(replay.out, testing::ContainsRegex("^[12][0-9]+ of [12][0-9]+ ticks the same"));
  EXPECT_THAT(replay.err, HasSubstr("cut.mcap: byte "));
  EXPECT_THAT(replay.err, HasSubstr("messages before it were read"));
}

TEST_F(Replay, RefusesWhatItCannotUse) {
  const std::string text = test::write_text(folder_.file("text.mcap"), "t_s,tick\n");
  const std::string late = changed([](TickRecord& tick) { return tick.tick >= 50; });
  const std::string empty = folder_.file("empty.mcap");
  { const Recorder recorder(empty, RecordingClock{}); }
  const std::string begins = "heel replay: ";
  test::expect_refused({
      {{"replay", folder_.file("none.mcap")}, begins, "none.mcap: cannot read: No such file or directory"},
      {{"replay", text}, begins, "text.mcap: not an MCAP file (expected a recording of heeld or"},
      {{"replay", late}, begins, "changed.mcap: its first tick is number 50 (expected 0"},
      {{"replay", empty}, begins, "empty.mcap: no control tick in this recording"},
      {{"replay", recording_, "--set", "gate.v_max"}, begins, "--set gate.v_max: no KEY=VALUE"},
      {{"replay", recording_, "--set", "gate.speed=1"}, begins, "--set gate.speed: no such key"},
      {{"replay", recording_, "--set", "gate.v_max_m_s=fast"}, begins, "configuration 0:"},
      {{"export", recording_}, "heel export: ", "nothing to export (expected --csv)"},
      {{"export", text, "--csv", "-o", folder_.file("csv")}, "heel export: ", "text.mcap: not an MCAP file"},
      {{"latency", text}, "heel latency: ", "text.mcap: not an MCAP file"},
      {{"latency", recording_}, "heel latency: ", "no stamps of frames"},
  });
  EXPECT_FALSE(std::filesystem::exists(folder_.file("csv")));
}

TEST_F(Replay, ABundleReplaysLikeItsRecording) {
  const std::string bundle = folder_.file("bundle.mcap");
  const Outcome packed = run_heel({"bundle", recording_, "-o", bundle});
  EXPECT_EQ(packed.status, 0) << packed.err;
  EXPECT_THAT(packed.out, AllOf(HasSubstr("devices.txt"), HasSubstr("versions.txt; without pictures\n")));
  EXPECT_EQ(run_heel({"replay", bundle}).status, 0);
  struct Nothing final : RecordingVisitor {
  } nothing;
  const RecordingReport report = read_recording(bundle, nothing);
  EXPECT_THAT(report.attachments.at("versions.txt"), AllOf(HasSubstr("heel "), HasSubstr("Linux ")));
}

TEST_F(Replay, ABundleReplaysWhenAPersonHasTheNameOfAKey) {
  BundleOptions options;
  for (const char* const name : {"robot", "gate", "auto", "model", "enabled", "following"})
    options.redaction.add_word(name, "USER");
  const std::string bundle = folder_.file("named.mcap");
  write_bundle(recording_, bundle, options);
  const Outcome replayed = run_heel({"replay", bundle});
  EXPECT_EQ(replayed.status, 0) << replayed.out << replayed.err;
}

TEST_F(Replay, ExportWritesTheColumnsOfTheManual) {
  const Outcome done = run_heel({"export", recording_, "--csv", "-o", folder_.file("csv")});
  EXPECT_EQ(done.status, 0) << done.err;
  const std::string ticks = test::read_text(folder_.file("csv/ticks.csv"));
  EXPECT_THAT(ticks, StartsWith("t_s,tick,lateness_us,"));
  EXPECT_EQ(std::count(ticks.begin(), ticks.end(), '\n'), 302);
  EXPECT_THAT(ticks, HasSubstr("\n6.000000000,300,"));
  const std::string poses = test::read_text(folder_.file("csv/poses.csv"));
  EXPECT_GT(std::count(poses.begin(), poses.end(), '\n'), 100);
}

}  // namespace
}  // namespace heel
