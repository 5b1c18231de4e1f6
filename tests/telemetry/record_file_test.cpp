// The file of a recording: pieces are whole, also large ones, and a full disk is named.
#include "telemetry/record_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "mcap/mcap_reader.h"
#include "mcap/mcap_writer.h"
#include "recording/recording_reader.h"
#include "support/collected_log.h"
#include "support/temporary_folder.h"
#include "telemetry/recorder.h"
#include "telemetry/small_disk.h"

namespace heel {
namespace {

using test::read_text;
using test::SmallDisk;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr std::size_t kLargeBytes = 5'000'000;
static_assert(kLargeBytes > RecordFile::kMaxWaitingBytes);

std::string line_of(char letter) {
  return std::string(99, letter) + '\n';
}

TEST(RecordFile, AFullDiskIsLoggedOnceAndPartialPiecesAreCompletedLater) {
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
  EXPECT_THAT(log.text(), HasSubstr("can be written again; 0 pieces were lost"));
}

TEST(RecordFile, PiecesThatDoNotFitIntoTheBufferAreLostWholeAndCounted) {
  const test::TemporaryFolder folder;
  const test::CollectedLog log;
  RecordFile file(folder.file("record"));
  const std::size_t fit = RecordFile::kMaxWaitingBytes / 100;
  {
    const SmallDisk disk(0);
    for (std::size_t i = 0; i < fit + 7; ++i) file.append(line_of('x'));
    file.flush();
  }
  EXPECT_EQ(file.pieces_lost(), 7u);
  file.flush();
  EXPECT_EQ(read_text(file.path()).size(), fit * 100);
  EXPECT_THAT(log.text(), HasSubstr("7 pieces were lost"));
}

TEST(RecordFile, ADeletedFileIsNamedOnce) {
  const test::TemporaryFolder folder;
  const test::CollectedLog log;
  RecordFile file(folder.file("record"));
  std::filesystem::remove(file.path());
  for (int i = 0; i < 3; ++i) {
    file.append(line_of('x'));
    file.flush();
  }
  EXPECT_EQ(log.count("cannot write: No such file or directory"), 1) << log.text();
}

TEST(RecordFile, ALargePieceIsWrittenAtOnceOrLater) {
  const test::TemporaryFolder folder;
  const test::CollectedLog log;
  const std::string large(kLargeBytes, 'x');
  RecordFile file(folder.file("record"));
  EXPECT_TRUE(file.append(line_of('a')));
  EXPECT_TRUE(file.append(large));
  EXPECT_EQ(read_text(file.path()), line_of('a') + large);
  {
    const SmallDisk disk(kLargeBytes + 1000);
    EXPECT_TRUE(file.append(large)) << "a part of it is written";
    EXPECT_FALSE(file.append(large)) << "the rest of the other one waits";
    EXPECT_EQ(file.pieces_lost(), 1u);
  }
  file.flush();
  EXPECT_EQ(read_text(file.path()), line_of('a') + large + large);
}

TEST(RecordFile, AttachmentsOfAnySizeAreKeptAndALostOneIsNamed) {
  const test::TemporaryFolder folder;
  const test::CollectedLog log;
  const std::string path = folder.file("run.mcap"), large(kLargeBytes, 'x');
  {
    Recorder recorder(path, RecordingClock{});
    recorder.attach("shirt-0.heel", "", large);
    EXPECT_EQ(recorder.records_lost(), 0u);
    const SmallDisk disk(std::filesystem::file_size(path));
    recorder.record_text(1, "the disk is full");
    recorder.flush();
    recorder.attach("shirt-1.heel", "", large);
    EXPECT_EQ(recorder.records_lost(), 1u);
  }
  EXPECT_EQ(log.count("run.mcap: the attachment shirt-1.heel (5000000 bytes) could not be written"), 1)
      << log.text();
  RecordingVisitor nothing;
  EXPECT_EQ(read_recording(path, nothing).attachments.at("shirt-0.heel"), large);
}

// A run of hours: the index of its chunks, which goes out in one piece, is large.
TEST(RecordFile, ARecordingOf40000ChunksHasItsEnd) {
  constexpr std::uint64_t kChunks = 40'000;
  const test::TemporaryFolder folder;
  const std::string path = folder.file("run.mcap");
  {
    RecordFile file(path);
    McapWriter writer([&](std::string_view piece) { return file.append(piece); }, {});
    const std::uint16_t schema = writer.add_schema("thing", "jsonschema", "{}");
    for (const char* const topic : {"/a", "/b", "/c", "/d"}) writer.add_channel(topic, schema);
    for (std::uint64_t i = 0; i < kChunks; ++i) {
      for (std::uint16_t channel = 0; channel < 4; ++channel)
        writer.write(channel, static_cast<TimeNs>(i), "{}");
      writer.end_chunk();
    }
    file.flush();
    const std::uint64_t before = std::filesystem::file_size(path);
    writer.finish();
    file.flush();
    EXPECT_GT(std::filesystem::file_size(path) - before, RecordFile::kMaxWaitingBytes);
  }
  std::ifstream file(path, std::ios::binary);
  McapReader reader(file, path);
  std::uint64_t messages = 0;
  for (McapMessage message; reader.next(message);) ++messages;
  EXPECT_EQ(messages, 4 * kChunks);
  EXPECT_TRUE(reader.complete());
  EXPECT_THAT(reader.problems(), IsEmpty());
}

}  // namespace
}  // namespace heel
