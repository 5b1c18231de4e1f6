// The order of baud rates: the last good one, then the rest from the slowest on, the same in each sweep.
#include "robot/baud_sweep.h"

#include <gtest/gtest.h>

namespace heel {
namespace {

BaudSweep sweep_from(const char* address) {
  return BaudSweep(parse_robot_address(address));
}

TEST(BaudSweep, TriesTheLastGoodRateThenTheOthersThenStartsAgain) {
  BaudSweep sweep = sweep_from("serial:/dev/ttyS1@38400");
  EXPECT_EQ(sweep.current(), 38400);
  for (const int expected : {9600, 19200, 57600, 115200}) {
    EXPECT_TRUE(sweep.advance());
    EXPECT_EQ(sweep.current(), expected);
  }
  EXPECT_FALSE(sweep.advance());
  EXPECT_EQ(sweep.current(), 38400);
}

TEST(BaudSweep, AfterAValidPacketTheNextSweepStartsFromTheFirstRate) {
  BaudSweep sweep = sweep_from("serial:/dev/ttyS1@38400");
  ASSERT_TRUE(sweep.advance());
  sweep.found();
  // The rate was raised; then the robot is switched off and on, and is at 9600 again.
  sweep.attempt(38400);
  sweep.found();
  ASSERT_TRUE(sweep.advance());
  EXPECT_EQ(sweep.current(), 9600);
}

TEST(BaudSweep, OverTcpThereIsOneRate) {
  BaudSweep sweep = sweep_from("tcp:localhost:8101");
  EXPECT_FALSE(sweep.sweeps());
  EXPECT_FALSE(sweep.advance());
}

}  // namespace
}  // namespace heel
