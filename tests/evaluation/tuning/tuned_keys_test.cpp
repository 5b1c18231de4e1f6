// Which keys can be tuned, and between which values.
#include "evaluation/tuning/tuned_keys.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/config_table.h"
#include "support/complaint.h"

namespace heel::evaluation {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(TunedKeys, AreThoseOfTheLawUnlessNamed) {
  Config config;
  for (const auto& [law, key] :
       {std::pair("view", "control.gain_yaw_1_s"), std::pair("trail", "control.trail_reach_m"),
        std::pair("position", "control.gain_lateral_rad_s_m")}) {
    config.control.law = law;
    std::vector<std::string> names;
    for (const TunedKey& tuned : tuned_keys(config, {}, 2.0)) names.push_back(tuned.name());
    EXPECT_THAT(names, testing::Contains(key)) << law;
    EXPECT_THAT(names, testing::Contains("control.gain_distance_1_s")) << law;
  }
  const auto named = tuned_keys(config, {"control.trail_delay_s"}, 2.0);
  ASSERT_EQ(named.size(), 1u);
  EXPECT_EQ(named.front().name(), "control.trail_delay_s");
}

TEST(TunedKeys, StayWithinTheFactorAndTheKeysOwnRange) {
  Config config;
  config.control.gain_yaw_1_s = 4.0;
  const TunedKey wide = tuned_keys(config, {"control.gain_yaw_1_s"}, 4.0).front();
  EXPECT_DOUBLE_EQ(wide.low, 1.0);
  EXPECT_DOUBLE_EQ(wide.high, config_keys()[wide.index].max);
  config.control.setpoint_t_x_m = -0.5;
  const TunedKey negative = tuned_keys(config, {"control.setpoint_t_x_m"}, 2.0).front();
  EXPECT_DOUBLE_EQ(negative.low, -1.0);
  EXPECT_DOUBLE_EQ(negative.high, -0.25);
}

TEST(TunedKeys, WhatCannotBeTunedIsNamedWithWhatCan) {
  const auto complaint = [](const std::vector<std::string>& names) {
    return test::complaint_of([&] { tuned_keys(Config{}, names, 2.0); });
  };
  EXPECT_THAT(complaint({"control.gain_yaw"}), HasSubstr("control.gain_yaw: no key of this name"));
  EXPECT_THAT(complaint({"control.gain_yaw"}), HasSubstr("control.gain_yaw_1_s"));
  EXPECT_THAT(complaint({"gate.v_max_m_s"}), HasSubstr("gate.v_max_m_s: cannot be tuned")) << "a limit";
  EXPECT_THAT(complaint({"control.law"}), HasSubstr("cannot be tuned"));
  EXPECT_THAT(complaint({"control.rate_hz"}), HasSubstr("cannot be tuned")) << "needs a restart";
  EXPECT_THAT(complaint({"control.setpoint_t_x_m"}), HasSubstr("is 0 in the configuration"));
  EXPECT_THAT(complaint({"control.gain_yaw_1_s", "control.gain_yaw_1_s"}), HasSubstr("given twice"));
}

TEST(TunedKeys, ValuesGoIntoTheirKeysAndNowhereElse) {
  const Config before;
  const auto keys = tuned_keys(before, {"control.gain_yaw_1_s", "control.gain_distance_1_s"}, 2.0);
  const Config after = with_values(before, keys, std::vector<double>{0.6, 1.4});
  EXPECT_EQ(after.control.gain_yaw_1_s, 0.6);
  EXPECT_EQ(after.control.gain_distance_1_s, 1.4);
  EXPECT_EQ(after.control.gain_lateral_rad_s_m, before.control.gain_lateral_rad_s_m);
  EXPECT_EQ(value_of(keys[1], after), 1.4);
  EXPECT_TRUE(relations_hold(after));
}

TEST(TunedKeys, ConditionsOnTwoKeysAreKept) {
  Config config;
  config.supervisor.certainty_drop = 0.9;  // above certainty_follow
  EXPECT_FALSE(relations_hold(config));
}

}  // namespace
}  // namespace heel::evaluation
