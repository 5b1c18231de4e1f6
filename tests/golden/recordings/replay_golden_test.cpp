// Kept recordings, a walk and a fault of each kind, replay to the bit. A change of the control side that
// changes decisions fails here, and names the first tick and every quantity that differs. When the change is
// meant:
//   HEEL_UPDATE_GOLDEN=1 build/release/bin/test_golden_recordings
// makes the recordings again: six seconds of `heel simulate`, of which the ticks and the configuration are
// kept.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>

#include "files/output_file.h"
#include "mcap/mcap_reader.h"
#include "mcap/mcap_writer.h"
#include "replay/control_replay.h"
#include "support/process.h"
#include "support/temporary_folder.h"
#include "support/test_data.h"

namespace heel {
namespace {

using testing::Contains;

struct Reference {
  const char* name;
  const char* fault;        ///< of the simulated robot; empty: none
  StopReason stopped_by;    ///< this happens in it …
  SupervisorState ends_in;  ///< … and before its last tick it is in this state
};

const Reference kReferences[] = {
    {"walk", "", StopReason::None, SupervisorState::Following},
    {"bumper", "bumper@3+0.3=4", StopReason::Bumper, SupervisorState::Following},
    {"stop_button", "stop_button@3+0.5", StopReason::StopButton, SupervisorState::Stopped},
    {"silence", "silence@3+1.5", StopReason::StaleSip, SupervisorState::Following},
    {"stall", "stall@3+0.5=1", StopReason::Stall, SupervisorState::Following},
};

std::string reference_path(const Reference& reference) {
  return test::source_path("tests/golden/recordings/") + reference.name + ".mcap";
}

/// Control computes with sin, cos and atan2, of which the C library has other last bits where the processor
/// has no fused multiply-add.
bool processor_is_like_that_of_the_references() {
#if defined(__x86_64__)
  return __builtin_cpu_supports("fma") != 0;
#else
  return false;
#endif
}

/// Ticks and configuration, as small as can be.
std::string shrunk(const std::string& recording) {
  std::ifstream file(recording, std::ios::binary);
  McapReader reader(file, recording);
  std::string bytes;
  McapWriter writer(
      [&](std::string_view piece) {
        bytes.append(piece);
        return true;
      },
      {.library = "heel", .chunk_bytes = 1 << 26, .chunk_ns = 3600 * kNsPerS, .compression_level = 19});
  std::map<std::string, std::uint16_t> channels;
  for (McapMessage message; reader.next(message);) {
    const McapChannel& channel = reader.channel(message.channel);
    if (channel.topic != "/heel/tick" && channel.topic != "/heel/configuration") continue;
    if (!channels.contains(channel.topic)) {
      const McapSchema* const schema = reader.schema(channel.schema);
      channels[channel.topic] =
          writer.add_channel(channel.topic, writer.add_schema(schema->name, schema->encoding, schema->text));
    }
    writer.write(channels.at(channel.topic), message.t_log_ns, message.data);
  }
  writer.finish();
  return bytes;
}

void make_again(const Reference& reference) {
  const test::TemporaryFolder folder;
  std::string scenario =
      "name = \"walk\"\nduration_s = 6.0\n[person]\nwalk_after_s = 0.0\n[[person.path]]\nstep = "
      "\"straight\"\n"
      "length_m = 5\n[robot]\nx_m = -1.8\n";
  if (*reference.fault != '\0') scenario += std::string("faults = [\"") + reference.fault + "\"]\n";
  const test::Outcome run = test::run_program(
      {test::built_program("heel"), "simulate", test::write_text(folder.file("walk.toml"), scenario),
       "--error-model", test::source_path("tools/heel-sim/pose_noise/pictured.toml"), "--out",
       folder.file("run")});
  ASSERT_NE(run.status, 2) << run.err;
  OutputFile file(reference_path(reference));
  file.write(shrunk(folder.file("run/run.mcap")));
  file.flush();
}

std::string explained(const ReplayResult& result) {
  std::ostringstream text;
  text << result.same << " of " << result.ticks << " ticks the same. " << result.ended << '\n';
  if (result.first) text << "first difference: tick " << result.first->recorded.tick << '\n';
  for (const auto& [name, quantity] : result.quantities)
    text << "  " << name << ": " << quantity.ticks << " ticks from " << quantity.first_tick << " on, at most "
         << quantity.largest << '\n';
  text << "If the change is meant: HEEL_UPDATE_GOLDEN=1 build/release/bin/test_golden_recordings\n";
  return text.str();
}

class KeptRecording : public testing::TestWithParam<Reference> {};

TEST_P(KeptRecording, ReplaysToTheBit) {
  const Reference& reference = GetParam();
  if (!processor_is_like_that_of_the_references())
    GTEST_SKIP() << "no fused multiply-add: sin and atan2 of the C library have other last bits";
  if (std::getenv("HEEL_UPDATE_GOLDEN") != nullptr) make_again(reference);
  std::set<StopReason> reasons;
  SupervisorState last_state{};
  ReplayOptions options;
  options.on_tick = [&](const TickRecord& recorded, const TickRecord& /*replayed*/) {
    reasons.insert(recorded.stop_reason);
    if (!recorded.input.shutdown) last_state = recorded.state;
  };
  const ReplayResult result = replay_control(reference_path(reference), options);
  EXPECT_TRUE(result.all_same()) << explained(result);
  EXPECT_EQ(result.ticks, 301u);
  EXPECT_THAT(result.report.other_version, testing::IsEmpty()) << "make the recordings again";
  // It is a recording of what its name says.
  EXPECT_THAT(reasons, Contains(StopReason::None));
  EXPECT_THAT(reasons, Contains(reference.stopped_by));
  EXPECT_EQ(last_state, reference.ends_in);
}

INSTANTIATE_TEST_SUITE_P(References, KeptRecording, testing::ValuesIn(kReferences),
                         [](const auto& kept) { return std::string(kept.param.name); });

}  // namespace
}  // namespace heel
