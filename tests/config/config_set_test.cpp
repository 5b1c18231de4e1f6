// Values that `heel set` gives a running daemon: what is refused, and why.
#include "config/config_set.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/config_table.h"
#include "config/config_value.h"

namespace heel {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

using Assignments = std::vector<ConfigAssignment>;

std::vector<std::string> reasons(const Assignments& assignments, const Config& current = {},
                                 const Config& file = {}) {
  try {
    with_assignments(current, file, assignments);
  } catch (const ConfigError& error) {
    return error.lines();
  }
  return {};
}

TEST(ConfigSet, TakesValuesOverAndLeavesTheOthers) {
  const Config before;
  const Config after = with_assignments(before, before,
                                        Assignments{{"control.gain_yaw_1_s", 0.5},
                                                    {"gate.v_max_m_s", 0.25},
                                                    {"supervisor.frames_to_follow", std::int64_t{9}},
                                                    {"runtime.log_level", std::string("debug")}});
  const std::vector<ConfigChange> changes = changes_between(before, after);
  ASSERT_EQ(changes.size(), 4u);
  EXPECT_EQ(changes[0].key, "control.gain_yaw_1_s");
  EXPECT_EQ(changes[0].after, "0.5");
  EXPECT_EQ(changes[1], (ConfigChange{"supervisor.frames_to_follow",
                                      std::to_string(before.supervisor.frames_to_follow), "9"}));
  EXPECT_EQ(changes[2].after, "0.25");
  EXPECT_EQ(changes[3], (ConfigChange{"runtime.log_level", "\"info\"", "\"debug\""}));
}

TEST(ConfigSet, ANegativeZeroIsZero) {
  const Config before;
  const Config after = with_assignments(before, before, Assignments{{"gate.v_max_m_s", -0.0}});
  EXPECT_THAT(changes_between(before, after), ElementsAre(ConfigChange{"gate.v_max_m_s", "0.7", "0.0"}));
}

TEST(ConfigSet, RefusesAsAFileDoes) {
  EXPECT_THAT(reasons({{"gate.v_max_m_s", std::string("fast")}}),
              ElementsAre("gate.v_max_m_s: 'fast' (expected a number 0…1.2 m/s)"));
  EXPECT_THAT(reasons({{"supervisor.frames_to_follow", 2.5}}),
              ElementsAre("supervisor.frames_to_follow: 2.5 (expected a whole number 1…1000 frames)"));
  EXPECT_THAT(reasons({{"control.gain_yaw", 1.0}}),
              ElementsAre("control.gain_yaw: no such key; did you mean control.gain_yaw_1_s?"));
  EXPECT_THAT(reasons({{"gate", 1.0}}), ElementsAre("gate: is a section (expected [gate])"));
  EXPECT_THAT(reasons({{"gate", 1.0}, {"gate.v_max_m_s", 0.1}}),
              ElementsAre(HasSubstr("gate: is a section")));
  EXPECT_THAT(reasons({{"speed", 1.0}}), ElementsAre(HasSubstr("speed: no such key")));
  EXPECT_THAT(reasons({{"", true}}), ElementsAre(HasSubstr("no such key")));
  EXPECT_THAT(reasons({{"gate.", true}}), ElementsAre(HasSubstr("gate.: no such key")));
}

TEST(ConfigSet, ChecksTheKeysAgainstEachOtherWithAllNewValues) {
  Config file;
  file.supervisor.certainty_follow = 0.1;
  file.supervisor.certainty_drop = 0.06;
  EXPECT_THAT(reasons({{"supervisor.certainty_drop", 0.2}}, file, file),
              ElementsAre("supervisor.certainty_drop: 0.2 (must not be larger than "
                          "supervisor.certainty_follow)"));
  EXPECT_THAT(reasons({{"supervisor.certainty_drop", 0.2}, {"supervisor.certainty_follow", 0.2}}, file, file),
              IsEmpty());
}

TEST(ConfigSet, KeysThatCannotChangeAreRefusedWithWhatToDo) {
  EXPECT_THAT(reasons({{"vision.octaves", std::int64_t{3}}}),
              ElementsAre("vision.octaves: cannot change while running (edit the file, then restart heeld)"));
  EXPECT_THAT(reasons({{"gate.deceleration_m_s2", 1.0}}),
              ElementsAre("gate.deceleration_m_s2: a limit that only the file sets (edit the file, then "
                          "reload heeld)"));
}

TEST(ConfigSet, ALimitIsMadeTighterAndBroughtBackButNeverLooserThanTheFile) {
  Config file;
  file.gate.v_max_m_s = 0.5;
  file.gate.separation_m = 1.0;
  file.control.reverse = false;
  Config tight = file;
  tight.gate.v_max_m_s = 0.1;
  EXPECT_THAT(reasons({{"gate.v_max_m_s", 0.5}, {"gate.separation_m", 1.0}}, tight, file), IsEmpty());
  EXPECT_THAT(
      reasons({{"gate.v_max_m_s", 0.51}, {"gate.separation_m", 0.9}}, tight, file),
      ElementsAre("gate.v_max_m_s: 0.51 (expected at most 0.5, the file's value: a limit is only made "
                  "tighter while heeld runs)",
                  "gate.separation_m: 0.9 (expected at least 1.0, the file's value: a limit is only "
                  "made tighter while heeld runs)"));
  EXPECT_THAT(reasons({{"control.reverse", true}}, tight, file),
              ElementsAre(HasSubstr("control.reverse: true (expected false, the file's value")));
  file.control.reverse = true;
  EXPECT_THAT(reasons({{"control.reverse", true}}, tight, file), IsEmpty());
}

/// A value of the key beside its default, in the direction.
double beside(const ConfigKey& key, const Config& config, bool larger) {
  const double value = number_value(key, config);
  return larger ? (value + key.max) / 2.0 : (value + key.min) / 2.0;
}

// Every limit of the gate and the supervisor, both ways.
TEST(ConfigSet, EveryLimitOfGateAndSupervisorHasASaferDirection) {
  int limits = 0;
  for (const ConfigKey& key : config_keys()) {
    if (key.reload != Reload::Yes || (key.section != "gate" && key.section != "supervisor")) continue;
    SCOPED_TRACE(key.full_name());
    ++limits;
    EXPECT_NE(key.tighter, Tighter::None);
    if (!key.can_be_set() || type_name(key) != "real") continue;
    const bool larger_is_tighter = key.tighter == Tighter::Larger;
    EXPECT_THAT(reasons({{key.full_name(), beside(key, {}, !larger_is_tighter)}}),
                ElementsAre(HasSubstr(key.full_name())));
  }
  EXPECT_GE(limits, 16);
}

}  // namespace
}  // namespace heel
