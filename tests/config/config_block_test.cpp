// The block of tuned values in a configuration's text: what was there is kept, and a second block replaces
// the first.
#include "config/config_block.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/config_edit.h"
#include "config/config_text.h"
#include "support/complaint.h"

namespace heel {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

const ConfigChange kYaw{"control.gain_yaw_1_s", "", "0.5"};
const ConfigChange kAlong{"control.gain_distance_1_s", "", "1.4"};

std::string with_block(const std::string& text, const std::vector<ConfigChange>& changes) {
  return config_text_with_block(text, "f.toml", changes, {"why", "when"});
}

TEST(ConfigBlock, StandsAtTheEndOfItsSectionAndKeepsWhatItReplaces) {
  EXPECT_EQ(with_block("# mine\n[control]\ngain_yaw_1_s = 1.0 # by hand\nlaw = \"view\"\n\n[gate]\n"
                       "separation_m = 1\n",
                       {kYaw, kAlong}),
            "# mine\n[control]\n# (before heel tune) gain_yaw_1_s = 1.0 # by hand\nlaw = \"view\"\n"
            "# >>> heel tune\n# why\n# when\ngain_yaw_1_s = 0.5\ngain_distance_1_s = 1.4\n"
            "# <<< heel tune\n\n[gate]\nseparation_m = 1\n");
}

TEST(ConfigBlock, GetsASectionWhereThereIsNone) {
  EXPECT_EQ(with_block("", {kYaw}),
            "[control]\n# >>> heel tune\n# why\n# when\ngain_yaw_1_s = 0.5\n# <<< heel tune\n");
  EXPECT_THAT(with_block("[gate]\r\nseparation_m = 1", {kYaw}),
              HasSubstr("separation_m = 1\r\n\r\n[control]\r\n# >>> heel tune\r\n"));
}

TEST(ConfigBlock, ASecondReplacesTheFirstAndKeepsItsOtherKeys) {
  const std::string first = with_block("[control]\nlaw = \"view\"\ngain_yaw_1_s = 1.0\n", {kYaw, kAlong});
  const std::string second = with_block(first, {{"control.gain_yaw_1_s", "", "0.7"}});
  EXPECT_EQ(second,
            "[control]\nlaw = \"view\"\n# (before heel tune) gain_yaw_1_s = 1.0\n# >>> heel tune\n# why\n"
            "# when\ngain_distance_1_s = 1.4\ngain_yaw_1_s = 0.7\n# <<< heel tune\n");
  EXPECT_EQ(with_block(second, {{"control.gain_yaw_1_s", "", "0.7"}}), second);
}

TEST(ConfigBlock, OfTheShippedFileChangesItsKeysOnly) {
  const std::string before = default_config_text();
  const std::string after = with_block(before, {kYaw, kAlong});
  const auto changes =
      changes_between(parse_config(before, "f.toml").config, parse_config(after, "f.toml").config);
  ASSERT_EQ(changes.size(), 2u);
  EXPECT_THAT(after, HasSubstr("# (before heel tune) gain_yaw_1_s = "));
}

TEST(ConfigBlock, AKeyThatIsSavedLaterDoesNotGetIntoIt) {
  const std::string text = with_block("[control]\nlaw = \"view\"\n", {kYaw});
  EXPECT_THAT(edited_config_text(text, "f.toml",
                                 std::vector<ConfigChange>{{"control.deadband_distance_m", "", "0.1"}}),
              HasSubstr("# <<< heel tune\ndeadband_distance_m = 0.1\n"));
  EXPECT_THAT(
      edited_config_text(text, "f.toml", std::vector<ConfigChange>{{"control.gain_yaw_1_s", "", "0.9"}}),
      HasSubstr("gain_yaw_1_s = 0.9\n# <<< heel tune"))
      << "its own keys are changed where they are";
}

TEST(ConfigBlock, WhatCannotBeEditedIsNamed) {
  const auto complaint = [](const std::string& text) {
    return test::complaint_of([&] { with_block(text, {kYaw}); });
  };
  EXPECT_THAT(complaint("[control]\n# >>> heel tune\ngain_yaw_1_s = 1.0\n"),
              HasSubstr("f.toml:2: '# >>> heel tune' without an end"));
  EXPECT_THAT(complaint("control = { gain_yaw_1_s = 1.0 }\n"),
              HasSubstr("f.toml:1: control.gain_yaw_1_s: is set in an inline table"));
  EXPECT_THAT(complaint("control.gain_yaw_1_s = 1.0\n"), HasSubstr("inline table or by a dotted key"));
  EXPECT_THAT(complaint("[control]\ngain_yaw_1_s = fast\n"), HasSubstr("f.toml:2"));
}

}  // namespace
}  // namespace heel
