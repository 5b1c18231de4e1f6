#include "toml/nearest_name.h"

#include <gtest/gtest.h>

namespace heel {
namespace {

TEST(EditDistance, CountsInsertionsDeletionsReplacementsAndSwaps) {
  struct Row {
    const char* a;
    const char* b;
    std::size_t distance;
  };
  for (const Row& row : {Row{"", "", 0}, Row{"", "abc", 3}, Row{"gain", "gain", 0}, Row{"gain", "gian", 1},
                         Row{"gain", "gin", 1}, Row{"gain", "grain", 1}, Row{"gain", "pain", 1},
                         Row{"kitten", "sitting", 3}, Row{"cofidence", "confidence", 1}}) {
    EXPECT_EQ(edit_distance(row.a, row.b), row.distance) << row.a << " " << row.b;
    EXPECT_EQ(edit_distance(row.b, row.a), row.distance) << row.b << " " << row.a;
  }
}

TEST(NearestName, TakesTheNearest) {
  EXPECT_EQ(nearest_name("control.gain_yaw", {"control.gain_yaw_1_s", "control.rate_hz"}),
            "control.gain_yaw_1_s");
}

TEST(NearestName, SuggestsNothingWhenAllNamesAreFar) {
  EXPECT_EQ(nearest_name("colour", {"control.rate_hz", "gate.v_max_m_s"}), "");
}

}  // namespace
}  // namespace heel
