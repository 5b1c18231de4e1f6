// Whole units whose mean is the wanted velocity.
#include "robot/velocity_rounding.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>

namespace heel {
namespace {

RC_GTEST_PROP(VelocityRounding, TheSumIsNeverOffByMoreThanHalfAUnit, ()) {
  VelocityRounding rounding(1000);
  double asked = 0.0;
  long sent = 0;
  const auto steps = *rc::gen::container<std::vector<int>>(rc::gen::inRange(-900'000, 900'000));
  for (const int milli : steps) {
    if (milli == 0) continue;
    asked += milli * 1e-3;
    sent += rounding.next(milli * 1e-3);
    RC_ASSERT(std::abs(asked - static_cast<double>(sent)) <= 0.5 + 1e-6);
  }
}

TEST(VelocityRounding, ZeroIsSentAtOnceAndClearsTheCarry) {
  VelocityRounding rounding(100);
  EXPECT_EQ(rounding.next(0.4), 0);
  EXPECT_EQ(rounding.next(0.0), 0);
  EXPECT_EQ(rounding.next(0.4), 0);  // 0.8 together, if the carry were kept
  EXPECT_EQ(rounding.next(0.4), 1);
}

TEST(VelocityRounding, KeepsToTheLimitAndTakesNotANumberAsZero) {
  VelocityRounding rounding(100);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(rounding.next(1e12), 100);
  EXPECT_EQ(rounding.next(-50.0), -50);  // the carry did not grow at the limit
  EXPECT_EQ(rounding.next(-1e300), -100);
  EXPECT_EQ(rounding.next(std::numeric_limits<double>::quiet_NaN()), 0);
  EXPECT_EQ(rounding.next(-std::numeric_limits<double>::infinity()), 0);
}

}  // namespace
}  // namespace heel
