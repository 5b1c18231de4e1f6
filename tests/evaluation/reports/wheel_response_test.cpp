// When wheels of given speeds have made half of a command's change.
#include "evaluation/reports/wheel_response.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/complaint.h"
#include "support/temporary_folder.h"
#include "support/text.h"

namespace heel::evaluation {
namespace {

using ::testing::HasSubstr;
using ::testing::Optional;

/// At rest until 10.1 s, at 0.2 m/s from 10.2 s, and at rest again from 10.4 s on.
WheelResponse there_and_back(const test::TemporaryFolder& folder) {
  const std::string path = folder.file("truth.csv");
  test::write_text(path,
                   "t_s,t_monotonic_s,wheel_left_m_s,wheel_right_m_s\n0,10.0,0,0\n0,10.1,0,0\n"
                   "0,10.2,0.1,0.3\n0,10.3,0.1,0.3\n0,10.4,0,0\n0,12.0,0,0\n");
  return WheelResponse(path);
}

constexpr TimeNs ms(int count) {
  return 10 * kNsPerS + count * kNsPerMs;
}

TEST(WheelResponse, IsTheMomentOfHalfTheChange) {
  const test::TemporaryFolder folder;
  const WheelResponse wheels = there_and_back(folder);
  EXPECT_THAT(wheels.half_way_ns(ms(20), 0.0, 0.2), Optional(ms(150)));
  EXPECT_THAT(wheels.half_way_ns(ms(20), 0.0, 0.1), Optional(ms(125)));
  EXPECT_THAT(wheels.half_way_ns(ms(250), 0.2, 0.0), Optional(ms(350)));
}

TEST(WheelResponse, IsUnknownWhereTheWheelsDoNotShowIt) {
  const test::TemporaryFolder folder;
  const WheelResponse wheels = there_and_back(folder);
  EXPECT_EQ(wheels.half_way_ns(ms(20), 0.0, 0.004), std::nullopt) << "too small";
  EXPECT_EQ(wheels.half_way_ns(ms(220), 0.0, 0.2), std::nullopt) << "they are there already";
  EXPECT_EQ(wheels.half_way_ns(ms(20), 0.0, 0.5), std::nullopt) << "they never get there";
  EXPECT_EQ(wheels.half_way_ns(ms(-100), 0.0, 0.2), std::nullopt) << "before the file begins";
  EXPECT_EQ(wheels.half_way_ns(ms(3000), 0.0, 0.2), std::nullopt) << "after it has ended";
  EXPECT_EQ(wheels.half_way_ns(ms(20), 0.0, std::numeric_limits<double>::quiet_NaN()), std::nullopt);
}

TEST(WheelResponse, WhatComesAfterASecondIsNoResponse) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("truth.csv");
  test::write_text(
      path, "t_monotonic_s,wheel_left_m_s,wheel_right_m_s\n10,0,0\n11.0,0,0\n11.2,0.2,0.2\n20,0.2,0.2\n");
  const WheelResponse wheels(path);
  EXPECT_EQ(wheels.half_way_ns(ms(100), 0.0, 0.2), std::nullopt);
  EXPECT_THAT(wheels.half_way_ns(ms(400), 0.0, 0.2), Optional(ms(1100)));
}

TEST(WheelResponse, AnotherCsvFileIsRefused) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("commands.csv");
  test::write_text(path, "t_s,v_m_s\n0,0\n");
  EXPECT_THAT(test::complaint_of([&] { WheelResponse{path}; }),
              HasSubstr(path + ": no columns t_monotonic_s and wheel_left_m_s (expected what heel-sim"));
}

}  // namespace
}  // namespace heel::evaluation
