// The direction of travel of many walks against truth: how far off it is, and whether the stated deviation is
// right, in every kind of motion and for small and large deviations alike.
#include "estimate/travel_filter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <vector>

#include "core/angles.h"
#include "estimate/walking_person.h"

namespace heel {
namespace {

using test::WalkingPerson;
using test::WalkPart;
using test::WalkTruth;

constexpr double kAcceleration_m_s2 = 1.0;

/// One frame: truth and estimates.
struct Sample {
  WalkTruth truth;
  double measured_rad = 0.0;
  DirectionEstimate travel, stride;
  Eigen::Vector2d measured_m;
  TravelFilter::Walk walk;
};

/// Of one filter over a walk. 5 % of the frames are missing one by one, some for 0.2 to 0.8 s.
std::vector<Sample> followed(const std::vector<WalkPart>& parts, Random& random, double missing = 0.05) {
  WalkingPerson person(parts, random);
  const double period_s = random.uniform() < 0.5 ? 1.0 / 30.0 : 1.0 / 15.0;
  std::vector<Sample> samples;
  TravelFilter filter;
  double t_next_s = 0.0, t_seen_s = -1e9;
  while (person.step()) {
    const double t_s = person.truth().t_s;
    if (t_s < t_next_s) continue;
    t_next_s += period_s;
    const BackMeasurement back = person.measure(period_s);
    if (random.uniform() < missing) {
      if (random.uniform() < 0.05) t_next_s += random.uniform(0.2, 0.8);
      continue;
    }
    if (t_seen_s < 0.0) {
      filter.start(back);
    } else {
      filter.predict(t_s - t_seen_s, kAcceleration_m_s2);
      filter.correct(back);
    }
    t_seen_s = t_s;
    samples.push_back(
        {person.truth(), back.yaw_rad, filter.travel(0.0), filter.stride(), back.position_m, filter.walk()});
  }
  return samples;
}

/// Errors of an estimate over samples.
struct Errors {
  void add(const DirectionEstimate& estimate, double true_rad) {
    const double error_rad = estimate.angle_rad - true_rad;
    squares += error_rad * error_rad;
    shares += error_rad * error_rad / (estimate.sigma_rad * estimate.sigma_rad);
    ++count;
  }
  double rms_deg() const { return kDegPerRad * std::sqrt(squares / count); }
  double nees() const { return shares / count; }  ///< mean of (error / sigma)²

  double squares = 0.0, shares = 0.0;
  int count = 0;
};

struct BothErrors {
  Errors travel, stride, measured;
};

BothErrors errors_of(const std::vector<Sample>& samples, const std::function<bool(const Sample&)>& chosen) {
  BothErrors errors;
  for (const Sample& sample : samples) {
    if (!chosen(sample)) continue;
    errors.travel.add(sample.travel, sample.truth.travel_rad);
    errors.stride.add(sample.stride, sample.truth.stride_travel_rad);
    errors.measured.add({sample.measured_rad, 1.0}, sample.truth.travel_rad);
  }
  return errors;
}

/// Two hundred walks of half a minute; without the first 2.5 s of each.
const std::vector<Sample>& walks() {
  static const std::vector<Sample> all = [] {
    std::vector<Sample> kept;
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
      Random random(seed);
      for (const Sample& sample : followed(test::any_walk(random), random)) {
        if (sample.truth.t_s > 2.5) kept.push_back(sample);
      }
    }
    return kept;
  }();
  return all;
}

bool walking(const Sample& sample) {
  return sample.truth.speed_m_s > 0.3;
}

void print(const char* what, const BothErrors& e) {
  std::printf("%-16s %6d frames: measured yaw %.2f, travel %.2f (%.2f), over a stride %.2f deg (%.2f)\n",
              what, e.travel.count, e.measured.rms_deg(), e.travel.rms_deg(), e.travel.nees(),
              e.stride.rms_deg(), e.stride.nees());
}

TEST(TravelFilter, KnowsTheDirectionOverAStrideToOneAndAHalfDegrees) {
  const BothErrors errors = errors_of(walks(), walking);
  print("walking", errors);
  EXPECT_LT(errors.stride.rms_deg(), 1.5);
  EXPECT_GT(errors.stride.nees(), 0.7);
  EXPECT_LT(errors.stride.nees(), 1.5);
  EXPECT_LT(errors.travel.rms_deg(), 0.55 * errors.measured.rms_deg());
}

TEST(TravelFilter, StatesTheRightDeviationInEveryKindOfMotion) {
  const struct {
    const char* what;
    std::function<bool(const Sample&)> chosen;
  } kinds[] = {
      {"straight", [](const Sample& s) { return walking(s) && std::abs(s.truth.turn_rad_s) < 0.05; }},
      {"fast", [](const Sample& s) { return s.truth.speed_m_s > 0.8; }},
      {"slow", [](const Sample& s) { return walking(s) && s.truth.speed_m_s < 0.6; }},
      {"in a bend", [](const Sample& s) { return walking(s) && std::abs(s.truth.turn_rad_s) > 0.15; }},
      {"standing",
       [](const Sample& s) { return s.truth.speed_m_s < 0.05 && std::abs(s.truth.turn_rad_s) < 0.05; }},
      {"turning on the spot",
       [](const Sample& s) { return s.truth.speed_m_s < 0.05 && std::abs(s.truth.turn_rad_s) > 0.1; }},
  };
  for (const auto& kind : kinds) {
    const BothErrors errors = errors_of(walks(), kind.chosen);
    print(kind.what, errors);
    EXPECT_GT(errors.travel.count, 3000) << kind.what;
    EXPECT_GT(errors.travel.nees(), 0.6) << kind.what;
    EXPECT_LT(errors.travel.nees(), 1.5) << kind.what;
    EXPECT_GT(errors.stride.nees(), 0.6) << kind.what;
    EXPECT_LT(errors.stride.nees(), 1.5) << kind.what;
  }
}

TEST(TravelFilter, StatesTheRightDeviationInEachThirdOfTheStatedOnes) {
  const auto sigma = [](const Sample& s) { return s.stride.sigma_rad; };
  std::vector<double> sigmas;
  for (const Sample& sample : walks())
    if (walking(sample)) sigmas.push_back(sigma(sample));
  std::sort(sigmas.begin(), sigmas.end());
  for (int third = 0; third < 3; ++third) {
    const double least = third == 0 ? 0.0 : sigmas[sigmas.size() * static_cast<std::size_t>(third) / 3];
    const double most = third == 2 ? 10.0 : sigmas[sigmas.size() * static_cast<std::size_t>(third + 1) / 3];
    const BothErrors errors = errors_of(
        walks(), [&](const Sample& s) { return walking(s) && sigma(s) >= least && sigma(s) < most; });
    print("third", errors);
    EXPECT_GT(errors.stride.nees(), 0.6) << third;
    EXPECT_LT(errors.stride.nees(), 1.8) << third;
    EXPECT_GT(errors.travel.nees(), 0.6) << third;
    EXPECT_LT(errors.travel.nees(), 1.8) << third;
  }
}

TEST(TravelFilter, TheBodySwaysLessThanTheBackAndItsSpeedIsKnown) {
  double back = 0.0, body = 0.0, speed = 0.0, shares = 0.0, turn = 0.0;
  int count = 0;
  for (const Sample& sample : walks()) {
    if (!walking(sample)) continue;
    const WalkTruth& truth = sample.truth;
    const Eigen::Vector2d n(-std::sin(truth.travel_rad), std::cos(truth.travel_rad));
    const Eigen::Vector2d truth_m(truth.x_m, truth.y_m);
    const double speed_error_m_s = sample.walk.forwards_m_s - truth.speed_m_s;
    back += std::pow(n.dot(sample.measured_m - truth_m), 2);
    body += std::pow(n.dot(sample.walk.position_m - truth_m), 2);
    speed += speed_error_m_s * speed_error_m_s;
    shares += std::pow(speed_error_m_s / sample.walk.forwards_sigma_m_s, 2);
    turn += std::pow(sample.walk.turn_rad_s - truth.turn_rad_s, 2);
    ++count;
  }
  ASSERT_GT(count, 10'000);
  const auto rms = [&](double squares) { return std::sqrt(squares / count); };
  std::printf("across the path: back %.4f m, body %.4f m; speed %.3f m/s (%.2f), turn %.3f rad/s\n",
              rms(back), rms(body), rms(speed), shares / count, rms(turn));
  EXPECT_LT(rms(body), 0.6 * rms(back));
  EXPECT_LT(rms(speed), 0.15);
  EXPECT_LT(rms(turn), 0.25);
}

TEST(TravelFilter, FollowsABendWithoutMuchDelay) {
  // 30°/s for two seconds, then straight on.
  Errors late;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Random random(1000 + seed);
    for (const Sample& s : followed({{1.0}, {4.0, 1.0}, {2.0, 1.0, 0.52}, {2.0, 1.0}}, random))
      if (s.truth.t_s > 6.0 && s.truth.t_s < 7.0) late.add(s.travel, s.truth.travel_rad);
  }
  EXPECT_LT(late.rms_deg(), 6.0);  // a delay of 0.2 s
}

TEST(TravelFilter, GivesTheYawOfTheBackOfAPersonWhoStepsAside) {
  Errors aside, after;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    Random random(2000 + seed);
    for (const Sample& s :
         followed({{1.5}, {2.5, 0.8}, {1.5}, {2.0, 0.0, 0.0, 0.4}, {1.0}, {4.0, 0.8}}, random)) {
      if (s.truth.t_s > 6.0 && s.truth.t_s < 8.0) aside.add(s.travel, s.truth.travel_rad);
      if (s.truth.t_s > 10.0) after.add(s.travel, s.truth.travel_rad);
    }
  }
  EXPECT_LT(aside.rms_deg(), 6.0);
  EXPECT_LT(after.rms_deg(), 4.0);
}

TEST(TravelFilter, GivesTheYawOfTheBackOfAPersonWhoWalksBackwards) {
  Errors back;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    Random random(3000 + seed);
    for (const Sample& s : followed({{1.5}, {2.5, 0.8}, {1.5}, {3.0, -0.3}, {1.0}}, random))
      if (s.truth.t_s > 5.5) back.add(s.travel, s.truth.travel_rad);
  }
  EXPECT_LT(back.rms_deg(), 6.0);
}

TEST(TravelFilter, OneWrongYawHardlyMovesIt) {
  Random random(5);
  WalkingPerson person({{1.0}, {5.0, 1.0}}, random);
  TravelFilter filter, disturbed;
  for (int frame = 0; person.step(); ++frame) {
    if (frame % 8 != 0) continue;
    const BackMeasurement back = person.measure(8 * WalkingPerson::kStep_s);
    BackMeasurement wrong = back;
    if (frame == 960) wrong.yaw_rad += 40.0 * kRadPerDeg;
    if (frame == 0) {
      filter.start(back);
      disturbed.start(back);
      continue;
    }
    for (TravelFilter* f : {&filter, &disturbed}) f->predict(8 * WalkingPerson::kStep_s, kAcceleration_m_s2);
    filter.correct(back);
    disturbed.correct(wrong);
    EXPECT_LT(std::abs(filter.travel(0.0).angle_rad - disturbed.travel(0.0).angle_rad), 4.0 * kRadPerDeg);
  }
}

TEST(TravelFilter, IsLessCertainAfterAGapAndAheadOfTheLastFrame) {
  Random random(6);
  WalkingPerson person({{4.0, 1.0}}, random);
  TravelFilter filter;
  filter.start(person.measure(0.1));
  for (int frame = 1; person.step(); ++frame) {
    if (frame % 8 != 0) continue;
    filter.predict(8 * WalkingPerson::kStep_s, kAcceleration_m_s2);
    filter.correct(person.measure(8 * WalkingPerson::kStep_s));
  }
  const double sigma_rad = filter.travel(0.0).sigma_rad;
  EXPECT_GT(filter.travel(0.2).sigma_rad, sigma_rad);
  TravelFilter after_gap = filter;
  after_gap.predict(0.2, kAcceleration_m_s2);
  EXPECT_NEAR(after_gap.travel(0.0).angle_rad, filter.travel(0.2).angle_rad, 1e-9);
  EXPECT_NEAR(after_gap.travel(0.0).sigma_rad, filter.travel(0.2).sigma_rad, 1e-3);
}

}  // namespace
}  // namespace heel
