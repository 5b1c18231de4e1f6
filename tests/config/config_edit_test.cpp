// New values in the text of a configuration file: everything else stays as it is.
#include "config/config_edit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "config/config_table.h"
#include "config/config_text.h"
#include "config/config_value.h"
#include "support/complaint.h"

namespace heel {
namespace {

using ::testing::HasSubstr;

std::string edited(const std::string& text, const std::vector<ConfigChange>& changes) {
  return edited_config_text(text, "f.toml", changes);
}
const ConfigChange kSpeed{"gate.v_max_m_s", "", "0.25"};
const ConfigChange kGain{"control.gain_yaw_1_s", "", "0.5"};

TEST(ConfigEdit, ReplacesAValueWhereItStands) {
  EXPECT_EQ(edited("# mine\n[gate] # limits\n  v_max_m_s   =  0.70   # slow, für drinnen\nseparation_m = 1\n",
                   {kSpeed}),
            "# mine\n[gate] # limits\n  v_max_m_s   =  0.25   # slow, für drinnen\nseparation_m = 1\n");
}

TEST(ConfigEdit, KeepsTheOrderAndTheCommentsOfTheShippedFile) {
  const Config defaults;
  Config wanted;
  wanted.gate.v_max_m_s = 0.3;
  wanted.control.reverse = true;
  wanted.estimate.outliers_to_reset = 7;
  wanted.runtime.log_level = "debug";
  const std::string before = default_config_text();
  const std::string after = edited(before, changes_between(defaults, wanted));
  EXPECT_TRUE(
      changes_between(parse_config(after, "f.toml").config, parse_config(before, "f.toml").config).size() ==
      4u);
  EXPECT_THAT(changes_between(wanted, parse_config(after, "").config), testing::IsEmpty());
  std::istringstream old_lines(before), new_lines(after);
  int differing = 0, lines = 0;
  for (std::string was, is; std::getline(old_lines, was); ++lines) {
    ASSERT_TRUE(std::getline(new_lines, is));
    differing += was != is;
  }
  EXPECT_EQ(differing, 4);
  EXPECT_GT(lines, 200);
}

TEST(ConfigEdit, ColumnsCountCharactersAndNotBytes) {
  EXPECT_EQ(edited("gate = { \"v_max_m_s\" = 0.7, separation_m = 0.9 } # ü\n", {kSpeed}),
            "gate = { \"v_max_m_s\" = 0.25, separation_m = 0.9 } # ü\n");
  EXPECT_EQ(edited("[camera]\ninfo = \"für_ü.yaml\"\n[target]\nmore_shirts = [\"ü\", # é\n "
                   "\"b\"]\n[gate]\nv_max_m_s=+7e-1",
                   {kSpeed}),
            "[camera]\ninfo = \"für_ü.yaml\"\n[target]\nmore_shirts = [\"ü\", # é\n "
            "\"b\"]\n[gate]\nv_max_m_s=0.25");
  EXPECT_EQ(edited("target = { shirt = \"ü.heel\", distance_m = 2.0 }\n", {{"target.distance_m", "", "3.0"}}),
            "target = { shirt = \"ü.heel\", distance_m = 3.0 }\n");
}

TEST(ConfigEdit, WindowsLineEndsAndAByteOrderMarkStay) {
  EXPECT_EQ(edited("\xEF\xBB\xBF[gate]\r\nv_max_m_s = 0.7\r\n\r\n[control]\r\n", {kSpeed, kGain}),
            "\xEF\xBB\xBF[gate]\r\nv_max_m_s = 0.25\r\n\r\n[control]\r\ngain_yaw_1_s = 0.5\r\n");
  EXPECT_EQ(edited("[gate]\r\nseparation_m = 1.0", {kSpeed, kGain}),
            "[gate]\r\nseparation_m = 1.0\r\nv_max_m_s = 0.25\r\n\r\n[control]\r\ngain_yaw_1_s = 0.5\r\n");
}

TEST(ConfigEdit, AddsAKeyBelowTheLastOneOfItsSection) {
  EXPECT_EQ(edited("[gate]\nclearance_m = 0.5 # wide\n# about control\n\n[control]\n", {kSpeed}),
            "[gate]\nclearance_m = 0.5 # wide\nv_max_m_s = 0.25\n# about control\n\n[control]\n");
  EXPECT_EQ(edited("[gate]\n# nothing yet\n[control]\n", {kSpeed}),
            "[gate]\nv_max_m_s = 0.25\n# nothing yet\n[control]\n");
  EXPECT_EQ(edited("[gate]", {kSpeed}), "[gate]\nv_max_m_s = 0.25\n");
}

TEST(ConfigEdit, AddsASectionAtTheEnd) {
  EXPECT_EQ(edited("", {kSpeed}), "[gate]\nv_max_m_s = 0.25\n");
  EXPECT_EQ(edited("[control]\nreverse = true", {kSpeed}),
            "[control]\nreverse = true\n\n[gate]\nv_max_m_s = 0.25\n");
  EXPECT_EQ(edited("# only a comment\n", {kSpeed, {"gate.separation_m", "", "2.0"}}),
            "# only a comment\n\n[gate]\nv_max_m_s = 0.25\nseparation_m = 2.0\n");
}

TEST(ConfigEdit, DottedKeysAndQuotedNamesAreReplaced) {
  EXPECT_EQ(edited("gate.v_max_m_s = 0.7\n", {kSpeed}), "gate.v_max_m_s = 0.25\n");
  EXPECT_EQ(edited("[\"gate\"]\n'v_max_m_s' = 0.7\n", {kSpeed}), "[\"gate\"]\n'v_max_m_s' = 0.25\n");
}

TEST(ConfigEdit, AKeyIsNotAddedToASectionInAnotherForm) {
  const auto complaint = [](const char* text) { return test::complaint_of([&] { edited(text, {kSpeed}); }); };
  EXPECT_EQ(
      complaint("\ngate = { separation_m = 0.9 }\n"),
      "f.toml:2:8: gate.v_max_m_s: cannot be added to a section that is written as an inline table or as "
      "dotted keys (expected [gate] on a line of its own)");
  EXPECT_THAT(complaint("gate.separation_m = 0.9\n"),
              HasSubstr("f.toml:1:1: gate.v_max_m_s: cannot be added"));
}

TEST(ConfigEdit, AFileWithAnErrorIsNotEdited) {
  EXPECT_THAT(test::complaint_of([] { edited("[gate\n", {kSpeed}); }), HasSubstr("f.toml:1"));
  EXPECT_THAT(test::complaint_of([] { edited("[gate]\nspeed = 1\n", {kSpeed}); }),
              HasSubstr("gate.speed: no such key"));
}

std::string text_of(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

// Each key that can be set, in the shipped file and in an empty one.
TEST(ConfigEdit, EveryKeyThatCanBeSetIsWrittenAndReadAgain) {
  int keys = 0;
  for (const ConfigKey& key : config_keys()) {
    if (!key.can_be_set() || type_name(key) != "real") continue;
    ++keys;
    const double value = (key.min + number_value(key, {})) / 2.0 + 1e-3;
    const ConfigChange change{key.full_name(), "", text_of(value)};
    for (const std::string& text : {default_config_text(), std::string()}) {
      // Alone the value may break a rule between keys: the reader then refuses it, as it does in a file.
      try {
        EXPECT_NEAR(number_value(key, parse_config(edited(text, {change}), "").config), value, 1e-6);
      } catch (const ConfigError& error) {
        EXPECT_THAT(error.what(), HasSubstr("must")) << key.full_name();
      }
    }
  }
  EXPECT_GT(keys, 20);
}

}  // namespace
}  // namespace heel
