// Recordings on disk: lines are whole, earlier recordings are kept, and a full disk does not end the
// recording.
#include "telemetry/recorder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <string>

#include "support/collected_log.h"
#include "support/complaint.h"
#include "support/temporary_folder.h"

namespace heel {
namespace {

using test::occurrences;
using test::read_text;
using testing::HasSubstr;

std::string line_of(char letter) {
  return std::string(99, letter) + '\n';
}

// While it lives, a file can have only so many bytes, as on a full disk.
class SmallDisk {
 public:
  explicit SmallDisk(rlim_t bytes) {
    getrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{.rlim_cur = bytes, .rlim_max = before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;
  ~SmallDisk() { setrlimit(RLIMIT_FSIZE, &before_); }

 private:
  rlimit before_{};
};

TEST(RecordFile, AFullDiskIsLoggedOnceAndPartialLinesAreCompletedLater) {
  const test::TemporaryFolder folder;
  const test::CollectedLog log;
  RecordFile file(folder.file("record"));
  {
    const SmallDisk disk(250);  // two and a half lines
    for (const char letter : {'a', 'b', 'c', 'd'}) {
      file.append(line_of(letter));
      file.flush();
    }
    EXPECT_EQ(read_text(file.path()).size(), 250u);
    EXPECT_EQ(log.count("cannot write: "), 1) << log.text();
    EXPECT_THAT(log.text(), HasSubstr(file.path()));
  }
  file.append(line_of('e'));
  file.flush();
  EXPECT_EQ(read_text(file.path()), line_of('a') + line_of('b') + line_of('c') + line_of('d') + line_of('e'));
  EXPECT_THAT(log.text(), HasSubstr("can be written again; 0 lines were lost"));
}

TEST(RecordFile, LinesThatDoNotFitIntoTheBufferAreLostWholeAndCounted) {
  const test::TemporaryFolder folder;
  const test::CollectedLog log;
  RecordFile file(folder.file("record"));
  const std::size_t fit = RecordFile::kMaxWaitingBytes / 100;
  {
    const SmallDisk disk(0);
    for (std::size_t i = 0; i < fit + 7; ++i) file.append(line_of('x'));
    file.flush();
  }
  EXPECT_EQ(file.lines_lost(), 7u);
  file.flush();
  EXPECT_EQ(read_text(file.path()).size(), fit * 100);
  EXPECT_THAT(log.text(), HasSubstr("7 lines were lost"));
}

TEST(Recorder, WritesHeadersAndRowsOfEachKind) {
  const test::TemporaryFolder folder;
  const std::string directory = folder.file("a/new/folder");
  Recorder recorder(directory);
  TickRecord tick;
  tick.input.now_ns = 1'500'000'000;
  recorder.record(tick);
  recorder.record(tick);
  PoseEstimate pose;
  pose.frame_sequence = 42;
  recorder.record(pose);
  recorder.record(CaptureCounters{.t_ns = 2'000'000'000, .captured = 11});
  Event event;
  event.t_ns = 3'000'000'000;
  event.kind = EventKind::FrameRefused;
  event.a = 320;
  event.b = 240;
  recorder.record(event);
  recorder.flush();

  const std::string ticks = read_text(directory + "/ticks.csv");
  EXPECT_EQ(ticks.substr(0, 9), "t_s,tick,");
  EXPECT_EQ(occurrences(ticks, "\n1.500000000,"), 2);
  EXPECT_EQ(occurrences(ticks, "\n"), 3);
  const std::string poses = read_text(directory + "/poses.csv");
  EXPECT_EQ(occurrences(poses, "\n"), 2);
  EXPECT_THAT(poses, HasSubstr(",42,"));
  EXPECT_EQ(read_text(directory + "/capture.csv"),
            "t_s,captured,dropped_by_driver,dropped_unread,reopened\n2.000000000,11,0,0,0\n");
  EXPECT_THAT(read_text(directory + "/events.log"),
              testing::MatchesRegex("[0-9.]+ recording begins at 20[0-9TZ:-]+\n"
                                    "3\\.000000000 frame refused: 320x240 px .*\n"));
}

TEST(Recorder, AllFilesOfAnEarlierRecordingGetTheSameNumber) {
  const test::TemporaryFolder folder;
  const std::string directory = folder.path();
  test::write_text(directory + "/ticks.csv", "first");
  { const Recorder second(directory); }
  test::write_text(directory + "/poses.2.csv", "someone else's");
  { const Recorder third(directory); }
  EXPECT_EQ(read_text(directory + "/ticks.1.csv"), "first");
  EXPECT_EQ(read_text(directory + "/poses.2.csv"), "someone else's");
  EXPECT_EQ(read_text(directory + "/ticks.3.csv").substr(0, 4), "t_s,");
  EXPECT_EQ(read_text(directory + "/poses.3.csv").substr(0, 4), "t_s,");
  EXPECT_THAT(read_text(directory + "/events.3.log"), HasSubstr("recording begins"));
  EXPECT_EQ(read_text(directory + "/ticks.csv").substr(0, 4), "t_s,");
}

TEST(Recorder, AFolderThatCannotBeMadeIsNamed) {
  const test::TemporaryFolder folder;
  const std::string file = test::write_text(folder.file("file"), "not a folder");
  EXPECT_THAT(test::complaint_of([&] { const Recorder recorder(file + "/run"); }),
              HasSubstr("telemetry.directory " + file + "/run"));
}

}  // namespace
}  // namespace heel
