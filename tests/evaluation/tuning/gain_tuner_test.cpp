// The bounded search: it finds a minimum that is known, stays within the bounds, and ends when it is told.
#include "evaluation/tuning/gain_tuner.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "config/config_table.h"

namespace heel::evaluation {
namespace {

using ::testing::DoubleNear;
using ::testing::SizeIs;

std::vector<TunedKey> keys_between(double low, double high, std::size_t count) {
  const std::vector<std::string> names{"control.gain_yaw_1_s", "control.gain_lateral_rad_s_m",
                                       "control.gain_distance_1_s"};
  std::vector<TunedKey> keys;
  for (std::size_t i = 0; i < count; ++i) keys.push_back({*index_of_key(names[i]), low, high});
  return keys;
}

const GoOn kToTheEnd = [](const SearchStep&) { return true; };

/// 0 at (0.5, 2, 1), rising with the logarithm of the distance.
double bowl(std::span<const double> values) {
  const double minimum[] = {0.5, 2.0, 1.0};
  double sum = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) sum += std::pow(std::log(values[i] / minimum[i]), 2);
  return sum;
}

TEST(GainTuner, FindsAMinimumThatIsKnown) {
  const auto steps = search(keys_between(0.2, 5.0, 3), {1.0, 1.0, 2.5}, bowl, 200, kToTheEnd);
  const SearchStep& best = best_step(steps);
  EXPECT_THAT(best.values[0], DoubleNear(0.5, 0.02));
  EXPECT_THAT(best.values[1], DoubleNear(2.0, 0.06));
  EXPECT_THAT(best.values[2], DoubleNear(1.0, 0.03));
  EXPECT_EQ(steps.front().values, (std::vector<double>{1.0, 1.0, 2.5}));
  EXPECT_EQ(steps.back().least_cost, best.cost);
}

TEST(GainTuner, FindsItWhereTheCostJumps) {
  // Costs of runs have steps: one tick more or less, a person lost or not.
  const Cost rough = [](std::span<const double> values) {
    const double cost = std::floor(20.0 * bowl(values)) / 20.0;
    return values[0] > 1.2 ? cost + 20.0 : cost;
  };
  const auto steps = search(keys_between(0.2, 5.0, 2), {1.0, 1.0}, rough, 100, kToTheEnd);
  EXPECT_LE(best_step(steps).cost, 0.05);
}

TEST(GainTuner, StaysWithinTheBoundsOfTheKeys) {
  const auto keys = keys_between(0.8, 1.5, 2);
  const auto steps = search(keys, {1.0, 1.0}, bowl, 100, kToTheEnd);
  for (const SearchStep& step : steps)
    for (const double value : step.values) {
      EXPECT_GE(value, 0.8);
      EXPECT_LE(value, 1.5);
    }
  EXPECT_THAT(best_step(steps).values[0], DoubleNear(0.8, 0.01));
  EXPECT_THAT(best_step(steps).values[1], DoubleNear(1.5, 0.02));
}

TEST(GainTuner, KeepsToBoundsOfNegativeValues) {
  const auto steps = search(
      keys_between(-3.0, -1.0 / 3.0, 1), {-1.0},
      [](std::span<const double> v) { return std::abs(v[0] + 2.0); }, 60, kToTheEnd);
  EXPECT_THAT(best_step(steps).values[0], DoubleNear(-2.0, 0.05));
}

TEST(GainTuner, EndsAfterTheStepsThatAreAllowedOrWhenItIsTold) {
  EXPECT_THAT(search(keys_between(0.2, 5.0, 3), {1.0, 1.0, 2.0}, bowl, 12, kToTheEnd), SizeIs(12));
  int left = 5;
  EXPECT_THAT(search(keys_between(0.2, 5.0, 3), {1.0, 1.0, 2.0}, bowl, 100,
                     [&](const SearchStep&) { return --left > 0; }),
              SizeIs(5));
}

TEST(GainTuner, AnErrorOfARunEndsIt) {
  EXPECT_THROW(
      search(
          keys_between(0.2, 5.0, 1), {1.0},
          [](std::span<const double>) -> double { throw std::runtime_error("no scenario"); }, 10, kToTheEnd),
      std::runtime_error);
}

}  // namespace
}  // namespace heel::evaluation
