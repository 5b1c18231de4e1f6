// MCAP files of ours: what is written is read, a cut file reads to its last whole chunk, and a damaged one is
// named with the place.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "heel/error.h"
#include "mcap/mcap_reader.h"
#include "mcap/mcap_writer.h"

namespace heel {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

struct Read {
  std::vector<std::string> messages;  // "topic time text"
  std::vector<std::string> problems;
  bool complete = false;
  std::map<std::string, McapAttachment> attachments;
};

Read read(const std::string& bytes) {
  std::istringstream file(bytes);
  McapReader reader(file, "run.mcap");
  Read all;
  for (McapMessage message; reader.next(message);) {
    const McapChannel& channel = reader.channel(message.channel);
    EXPECT_EQ(channel.encoding, "json");
    EXPECT_NE(reader.schema(channel.schema), nullptr);
    all.messages.push_back(channel.topic + ' ' + std::to_string(message.t_log_ns) + ' ' +
                           std::string(message.data));
  }
  all.problems = reader.problems();
  all.complete = reader.complete();
  all.attachments = reader.attachments();
  return all;
}

class McapFile : public testing::Test {
 protected:
  McapFile() {
    const std::uint16_t schema = writer_.add_schema("thing", "jsonschema", R"({"type":"object"})");
    a_ = writer_.add_channel("/a", schema);
    b_ = writer_.add_channel("/b", schema);
  }
  std::string text(int i) const { return "{\"i\":" + std::to_string(i) + '}'; }

  std::string bytes_;
  bool full_ = false;
  McapWriter writer_{[this](std::string_view piece) {
                       if (!full_) bytes_.append(piece);
                       return !full_;
                     },
                     {.chunk_bytes = 2000}};
  std::uint16_t a_ = 0, b_ = 0;
};

TEST_F(McapFile, GivesEveryMessageBackInOrder) {
  std::vector<std::string> written;
  for (int i = 0; i < 500; ++i) {
    const TimeNs t_ns = i * 30 * kNsPerMs;
    writer_.write(i % 3 == 0 ? b_ : a_, t_ns, text(i));
    written.push_back((i % 3 == 0 ? "/b " : "/a ") + std::to_string(t_ns) + ' ' + text(i));
  }
  writer_.add_attachment("camera.yaml", "text/yaml", "width: 640\n", 7);
  writer_.finish();
  const Read all = read(bytes_);
  EXPECT_EQ(all.messages, written);
  EXPECT_TRUE(all.complete);
  EXPECT_THAT(all.problems, IsEmpty());
  EXPECT_EQ(all.attachments.at("camera.yaml").data, "width: 640\n");
  EXPECT_EQ(writer_.messages(), 500u);
  EXPECT_EQ(writer_.bytes(), bytes_.size());
}

TEST_F(McapFile, AChunkEndsByTimeAndBySize) {
  const auto size = [this] { return bytes_.size(); };
  writer_.write(a_, 0, text(1));
  const std::size_t begin = size();
  writer_.write(a_, kNsPerS - 1, text(2));
  EXPECT_EQ(size(), begin) << "less than a second";
  writer_.write(a_, kNsPerS, text(3));
  EXPECT_GT(size(), begin) << "the chunk of the first two";
  const std::size_t second = size();
  writer_.write(a_, kNsPerS, std::string(2000, 'x'));
  EXPECT_GT(size(), second);
}

TEST_F(McapFile, CutAnywhereItReadsToItsLastWholeChunk) {
  for (int i = 0; i < 40; ++i) {
    writer_.write(a_, i * kNsPerS / 4, text(i));
  }
  writer_.finish();
  std::size_t before = 0;
  for (std::size_t cut = kMcapMagic.size(); cut < bytes_.size(); ++cut) {
    const Read part = read(bytes_.substr(0, cut));
    ASSERT_GE(part.messages.size(), before) << cut;
    ASSERT_EQ(part.messages.size() % 4, 0u) << "four a chunk";
    before = part.messages.size();
    if (!part.complete) {
      ASSERT_EQ(part.problems.size(), 1u) << cut;
      ASSERT_THAT(part.problems[0], testing::StartsWith("run.mcap: byte "));
    }
  }
  EXPECT_EQ(before, 40u);
}

TEST_F(McapFile, ADamagedChunkIsLeftOutAndNamed) {
  std::mt19937 random(3);
  for (int i = 0; i < 30; ++i) {
    writer_.write(a_, i * kNsPerS / 10, "{\"x\":\"" + std::to_string(random()) + "\"}");
  }
  writer_.finish();
  // The second chunk: behind the first one.
  const std::string op(1, '\x06');
  const std::size_t first = bytes_.find("zstd");
  const std::size_t second = bytes_.find("zstd", first + 4);
  std::string damaged = bytes_;
  damaged[second + 40] ^= 1;
  const Read part = read(damaged);
  EXPECT_EQ(part.messages.size(), 20u);
  EXPECT_TRUE(part.complete);
  ASSERT_EQ(part.problems.size(), 1u);
  EXPECT_THAT(part.problems[0], HasSubstr("it was left out"));
}

TEST_F(McapFile, WhatTheSinkRefusesIsCountedAndTheRestIsRight) {
  writer_.write(a_, 0, text(1));
  writer_.end_chunk();
  full_ = true;
  writer_.write(a_, 1, text(2));
  writer_.write(b_, 2, text(3));
  writer_.end_chunk();
  full_ = false;
  writer_.write(a_, 3, text(4));
  writer_.finish();
  EXPECT_EQ(writer_.messages_lost(), 2u);
  EXPECT_EQ(writer_.messages(), 2u);
  const Read all = read(bytes_);
  EXPECT_THAT(all.messages, ElementsAre("/a 0 {\"i\":1}", "/a 3 {\"i\":4}"));
  EXPECT_TRUE(all.complete);
}

TEST_F(McapFile, AnyDamageIsNamedAndNeverCrashes) {
  for (int i = 0; i < 20; ++i) writer_.write(i % 2 == 0 ? a_ : b_, i * kNsPerS / 5, text(i));
  writer_.finish();
  std::mt19937 random(1);
  int noticed = 0;
  for (int run = 0; run < 2000; ++run) {
    std::string damaged = bytes_;
    for (int flips = 1 + static_cast<int>(random() % 3); flips > 0; --flips)
      damaged[random() % damaged.size()] = static_cast<char>(random());
    try {
      std::istringstream file(damaged);
      McapReader reader(file, "run.mcap");
      for (McapMessage message; reader.next(message);) EXPECT_LE(message.data.size(), damaged.size() * 100);
      noticed += !reader.problems().empty();
    } catch (const Error&) {
      ++noticed;
    }
  }
  EXPECT_GT(noticed, 500);
}

TEST(McapReader, RefusesWhatIsNoMcapFile) {
  for (const char* bytes : {"", "short", "t_s,tick,lateness_us\n1,2,3\n"}) {
    std::istringstream file{std::string(bytes)};
    try {
      McapReader reader(file, "run.mcap");
      ADD_FAILURE() << bytes;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr("run.mcap: not an MCAP file (expected"));
    }
  }
}

}  // namespace
}  // namespace heel
