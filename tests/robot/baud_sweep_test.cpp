// The order of baud rates: a quick look at the likely ones, then each, the same in every sweep.
#include "robot/baud_sweep.h"

#include <gtest/gtest.h>

#include <initializer_list>

namespace heel {
namespace {

BaudSweep sweep_from(const char* address) {
  return BaudSweep(parse_robot_address(address));
}

void expect_order(BaudSweep& sweep, std::initializer_list<int> rates, int quick) {
  int place = 0;
  for (const int expected : rates) {
    const bool advanced = place == 0 || sweep.advance();
    EXPECT_TRUE(advanced);
    EXPECT_EQ(sweep.current(), expected) << place;
    EXPECT_EQ(sweep.quick(), place < quick) << place;
    ++place;
  }
  EXPECT_FALSE(sweep.advance());
  EXPECT_EQ(sweep.current(), *rates.begin()) << "it starts again";
}

TEST(BaudSweep, LooksAtTheLastGoodRateAndAtThatOfPowerOnAndThenTriesEach) {
  BaudSweep sweep = sweep_from("serial:/dev/ttyS1@38400");
  expect_order(sweep, {38400, 9600, 38400, 9600, 19200, 57600, 115200}, 2);
  expect_order(sweep, {38400, 9600, 38400, 9600, 19200, 57600, 115200}, 2);
}

TEST(BaudSweep, OneRateIsNotTriedTwice) {
  BaudSweep sweep = sweep_from("serial:/dev/ttyS1@9600");
  expect_order(sweep, {9600, 19200, 38400, 57600, 115200}, 0);
}

TEST(BaudSweep, AfterCloseThePowerOnRateComesFirst) {
  BaudSweep sweep = sweep_from("serial:/dev/ttyS1@38400");
  sweep.restart_after_close();
  EXPECT_EQ(sweep.current(), 9600);
  EXPECT_TRUE(sweep.quick());
  EXPECT_TRUE(sweep.advance());
  EXPECT_EQ(sweep.current(), 38400);
  EXPECT_TRUE(sweep.quick());
  // A controller that powers on at another rate has said so.
  sweep.set_power_on(57600);
  sweep.restart_after_close();
  EXPECT_EQ(sweep.current(), 57600);
  EXPECT_EQ(sweep.good(), 38400);
}

TEST(BaudSweep, AfterAValidPacketTheNextSweepStartsWithThatRate) {
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
  EXPECT_FALSE(sweep.quick());
  sweep.restart_after_close();
  EXPECT_EQ(sweep.current(), 115200);
  EXPECT_FALSE(sweep.advance());
}

}  // namespace
}  // namespace heel
