// Bundles: no private thing goes in, what is too large is left out in the order of its use, and the ticks
// replay.
#include "recording/bundle.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "recording/private_wire.h"
#include "recording/recording_reader.h"
#include "recording/redacted_message.h"
#include "support/complaint.h"
#include "support/temporary_folder.h"
#include "telemetry/recorder.h"

namespace heel {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr std::uint64_t kRun = 800;  // ticks

TEST(Redaction, ReplacesWholeWordsHomesAndSerialNumbers) {
  Redaction redaction;
  redaction.add_word("pi", "USER");
  redaction.add_word("robot-7", "HOST");
  redaction.add_word("", "NOTHING");
  EXPECT_EQ(redaction.applied("pi at robot-7: pixels of pi.heel, api, pi_2"),
            "USER at HOST: pixels of USER.heel, api, pi_2");
  EXPECT_EQ(redaction.applied("shirt = \"/home/anna/red.heel\" \"/home/bob\""),
            "shirt = \"/home/USER/red.heel\" \"/home/USER\"");
  EXPECT_EQ(redaction.applied("serial:/dev/serial/by-id/usb-FTDI_A50285BI-if00@38400 and more"),
            "serial:/dev/serial/by-id/DEVICE@38400 and more");
}

TEST(Redaction, OfAConfigurationOnlyPathsAndAddressesChange) {
  Redaction redaction;
  for (const char* const name : {"robot", "address", "jpeg", "anna"}) redaction.add_word(name, "X");
  EXPECT_EQ(redaction.applied_to_toml(
                "# of anna\n[robot]\naddress = \"tcp:robot.local:8101\"\nx = [1, 2] # anna's\n"
                "pictures = \"jpeg\"\nshirts = [\"/srv/anna/\\\"robot\\\".heel\", 'anna.heel']\n"),
            "# of X\n[robot]\naddress = \"tcp:HOST:8101\"\nx = [1, 2] # X's\n"
            "pictures = \"jpeg\"\nshirts = [\"/srv/X/\\\"X\\\".heel\", 'X.heel']\n");
  EXPECT_EQ(redaction.applied_to_toml("[mqtt]\nuser = \"otto\"\n[x]\nuser = \"\"\n"),
            "[mqtt]\nuser = \"USER\"\n[x]\nuser = \"\"\n");
  EXPECT_EQ(redaction.applied_to_toml("robot = \"robot/"), "robot = \"X/") << "an end in the middle";
}

TEST(Redaction, ReplacesHostsOfTcpAddresses) {
  const Redaction redaction;
  EXPECT_EQ(redaction.applied(
                "tcp:10.0.0.7:8101, tcp:[fe80::1]:8101 and tcp:anna.local:1; over tcp: no rates, tcp:"),
            "tcp:HOST:8101, tcp:HOST:8101 and tcp:HOST:1; over tcp: no rates, tcp:");
  EXPECT_EQ(redaction.applied("tcp://broker.anna.example:1883, ssl://[fe80::1]:8883 and https://a.org:80"),
            "tcp://HOST:1883, ssl://HOST:8883 and https://a.org:80");
}

TEST(Redaction, MessagesKeepTheirMembersAndEnumerators) {
  Redaction redaction;
  for (const char* const name : {"message", "text", "kind", "mark"}) redaction.add_word(name, "X");
  EXPECT_EQ(redacted_message(redaction, "/heel/recording", note_json({7, "mark", "a mark\nmark", 0})),
            note_json({7, "mark", "a X\nX", 0}));
  EXPECT_EQ(redacted_message(redaction, "/heel/tick", "{\"mark\":1}"), "{\"mark\":1}");
}

std::uint16_t sum_of(std::string_view body) {
  std::uint16_t sum = 0;
  for (std::size_t i = 0; i + 1 < body.size(); i += 2)
    sum = static_cast<std::uint16_t>(
        sum + (static_cast<std::uint8_t>(body[i]) << 8 | static_cast<std::uint8_t>(body[i + 1])));
  return body.size() % 2 == 0 ? sum
                              : static_cast<std::uint16_t>(sum ^ static_cast<std::uint8_t>(body.back()));
}

std::string packet_of(const std::string& body, std::uint16_t sum) {
  return std::string("\xFA\xFB") + static_cast<char>(body.size() + 2) + body + static_cast<char>(sum >> 8) +
         static_cast<char>(sum);
}

/// What the robot sends in a recording and in its bundle: all bytes.
struct FromRobot final : RecordingVisitor {
  void on_wire(const WireBytes& wire) override {
    if (!wire.to_robot) bytes.append(wire.bytes.begin(), wire.bytes.begin() + wire.count);
  }
  std::string bytes;
};

TEST(BundledWire, HasNeitherSerialNumberNorNameOfTheRobot) {
  using namespace std::string_literals;
  const auto config = [](const std::string& serial, const std::string& name) {
    return "\x20Pioneer\0p3at-sh\0"s + serial + "\0\1\x2c\1\2\3\4\5\6\7\x8\x9"s + name +
           "\0\x64\3 more of it"s;
  };
  const auto echo = [](const std::string& name) { return "\2"s + name + "\0Pioneer\0p3at-sh\0"s; };
  const auto bytes = [&](const std::string& serial, const std::string& name) {
    const std::string body = config(serial, name), of_echo = echo(name);
    const std::uint16_t wrong = 0x1234;
    return "\xFA\xFB\xFF\x20 noise"s + packet_of(of_echo, sum_of(of_echo)) +
           packet_of("\x32 rosie\0"s, sum_of("\x32 rosie\0"s)) + packet_of(body, sum_of(body)) +
           packet_of(body, wrong) + packet_of(body, sum_of(body)).substr(0, 50);
  };
  const test::TemporaryFolder folder;
  const std::string sent = bytes("SN-00042", "rosie");
  {
    Recorder recorder(folder.file("run.mcap"), RecordingClock{});
    for (std::size_t at = 0; at < sent.size(); at += 7) {
      const std::string part = sent.substr(at, 7);
      recorder.record_wire({reinterpret_cast<const std::uint8_t*>(part.data()), part.size()},
                           /*to_robot=*/false, 1);
      recorder.record_wire(std::vector<std::uint8_t>{0xFA, 0xFB, 3, 0, 0, 0}, /*to_robot=*/true, 1);
    }
  }
  write_bundle(folder.file("run.mcap"), folder.file("bundle.mcap"), {});
  FromRobot before, after;
  read_recording(folder.file("run.mcap"), before);
  read_recording(folder.file("bundle.mcap"), after);
  EXPECT_EQ(before.bytes, sent);
  EXPECT_EQ(after.bytes, bytes("--------", "-----")) << "the sums of right packets are right";
}

struct Bundled final : RecordingVisitor {
  void on_tick(const TickRecord& tick) override {
    if (ticks++ == 0) first_tick = tick.tick;
  }
  void on_pose(const PoseEstimate&) override { ++poses; }
  void on_wire(const WireBytes&) override { ++wire; }
  void on_picture(const RecordedPicture&) override { ++pictures; }
  void on_configuration(const ConfigurationText& text) override { configuration = text.text; }
  std::uint64_t ticks = 0, first_tick = 0, poses = 0, wire = 0, pictures = 0;
  std::string configuration;
};

class Bundle : public testing::Test {
 protected:
  /// 16 s whose wire and poses do not compress.
  Bundle() {
    std::mt19937_64 random(5);
    const std::vector<std::uint8_t> grey(64 * 48, 100);
    Recorder recorder(recording_, RecordingClock{});
    recorder.record(ConfigurationText{0, 0, "[target]\nshirt = \"/home/anna/red.heel\"\n"});
    recorder.attach("shirt-0.heel", "", "a picture of a shirt");
    for (std::uint64_t i = 0; i < kRun; ++i) {
      const TimeNs t_ns = static_cast<TimeNs>(i) * 20 * kNsPerMs;
      TickRecord tick;
      tick.tick = i;
      tick.input.now_ns = t_ns;
      tick.target.x_m = std::normal_distribution<double>()(random);
      recorder.record(tick);
      WireBytes wire{.t_ns = t_ns, .count = 50};
      for (std::size_t k = 0; k < wire.count; ++k) wire.bytes[k] = static_cast<std::uint8_t>(random());
      recorder.record(wire);
      PoseEstimate pose;
      pose.t_done_ns = t_ns;
      for (double& value : pose.H_cur_from_ref) value = std::normal_distribution<double>()(random);
      recorder.record(pose);
      if (i % 100 == 0) recorder.record(compressed_picture({{i, t_ns, 64, 48}, grey.data(), 64}, true));
    }
  }
  Bundled bundled(const BundleOptions& options) {
    report_ = write_bundle(recording_, bundle_, options);
    EXPECT_EQ(report_.bytes, std::filesystem::file_size(bundle_));
    EXPECT_LE(report_.bytes, options.max_bytes);
    Bundled content;
    read_report_ = read_recording(bundle_, content);
    EXPECT_TRUE(read_report_.complete);
    EXPECT_THAT(read_report_.problems, IsEmpty());
    return content;
  }

  const test::TemporaryFolder folder_;
  const std::string recording_ = folder_.file("run.mcap"), bundle_ = folder_.file("bundle.mcap");
  BundleReport report_;
  RecordingReport read_report_;
};

TEST_F(Bundle, LeavesOutPicturesAndPrivateNames) {
  BundleOptions options;
  options.texts = {{"journal.txt", "anna: /home/anna is full"}};
  options.redaction.add_word("anna", "USER");
  const Bundled content = bundled(options);
  EXPECT_EQ(content.ticks, kRun);
  EXPECT_EQ(content.poses, kRun);
  EXPECT_EQ(content.wire, kRun);
  EXPECT_EQ(content.pictures, 0u);
  EXPECT_EQ(content.configuration, "[target]\nshirt = \"/home/USER/red.heel\"\n");
  EXPECT_EQ(read_report_.attachments.size(), 1u) << "no template";
  EXPECT_EQ(read_report_.attachments.at("journal.txt"), "USER: /home/USER is full");
  EXPECT_THAT(report_.left_out, IsEmpty());
  options.with_pictures = true;
  EXPECT_EQ(bundled(options).pictures, kRun / 100);
  EXPECT_EQ(read_report_.attachments.at("shirt-0.heel"), "a picture of a shirt");
}

TEST_F(Bundle, WhatIsTooLargeIsLeftOutInOrder) {
  BundleOptions options;
  const std::uint64_t all = (bundled(options), report_.bytes);
  options.max_bytes = all - 1;
  Bundled content = bundled(options);
  EXPECT_EQ(content.wire, 0u);
  EXPECT_EQ(content.poses, kRun);
  ASSERT_EQ(report_.left_out.size(), 1u);
  EXPECT_THAT(report_.left_out[0], HasSubstr("the bytes on the wire"));
  options.max_bytes = report_.bytes - 1;
  content = bundled(options);
  EXPECT_EQ(content.poses, 0u);
  EXPECT_EQ(content.ticks, kRun);
  EXPECT_EQ(content.first_tick, 0u);
  options.max_bytes = report_.bytes * 2 / 3;
  content = bundled(options);
  EXPECT_NEAR(static_cast<double>(content.ticks), 0.5 * kRun, 2.0);
  EXPECT_NE(content.configuration, "") << "it is always there";
  EXPECT_THAT(report_.left_out[0], HasSubstr("all but the last 8 s"));
}

TEST(RecordingOfTheService, IsInTheFirstFolderThatHasOne) {
  const test::TemporaryFolder folder;
  const std::string absent = folder.file("absent"), state = folder.file("state"), run = folder.file("run");
  for (const std::string& made : {state, run}) std::filesystem::create_directory(made);
  const auto complaint = [&] {
    return test::complaint_of([&] { recording_in_first_of({absent, state, run}); });
  };
  EXPECT_EQ(complaint(), absent + ": No such file or directory; " + state +
                             ": no recording in this folder (expected a file *.mcap); " + run +
                             ": no recording in this folder (expected a file *.mcap); no recording of the "
                             "service (expected one there, or a recording as argument)");
  test::write_text(run + "/black-box.mcap", "");
  EXPECT_EQ(recording_in_first_of({absent, state, run}), run + "/black-box.mcap");
  test::write_text(state + "/walk.mcap", "");
  EXPECT_EQ(recording_in_first_of({absent, state, run}), state + "/walk.mcap");
}

}  // namespace
}  // namespace heel
