// The limits of acceleration and jerk hold for every wanted velocity; the limiter lands without overshoot and
// goes on from what the gate let through.
#include "control/comfort_limiter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/random.h"

namespace heel {
namespace {

constexpr TimeNs kPeriod_ns = 20 * kNsPerMs;
constexpr double kPeriod_s = 0.02;

struct Limited {
  Config config;
  ControlConfig& control = config.control;
  ComfortLimiter limiter;
  VelocityCommand command;
  TimeNs now_ns = kNsPerS;
  std::vector<double> v_m_s;

  Limited() {
    limiter.reconfigure(config);
    command.t_issued_ns = now_ns;
    command.t_expires_ns = now_ns + 10 * kPeriod_ns;
  }
  WantedVelocity tick(double wanted_m_s, double wanted_rad_s = 0.0) {
    now_ns += kPeriod_ns;
    const WantedVelocity out = limiter.limited({wanted_m_s, wanted_rad_s}, command, now_ns);
    command.t_issued_ns = now_ns;
    command.t_expires_ns = now_ns + 10 * kPeriod_ns;
    command.v_m_s = out.v_m_s;
    command.yaw_rate_rad_s = out.yaw_rate_rad_s;
    v_m_s.push_back(out.v_m_s);
    return out;
  }
};

TEST(ComfortLimiter, AccelerationAndJerkHoldForEveryWantedVelocity) {
  Limited run;
  Random random(3);
  double wanted = 0.0;
  for (int i = 0; i < 5000; ++i) {
    if (i % 17 == 0) wanted = random.uniform(-0.7, 0.7);
    run.tick(i % 3 == 0 ? wanted + random.uniform(-0.1, 0.1) : wanted);
  }
  int accelerations = 0;
  for (std::size_t i = 2; i < run.v_m_s.size(); ++i) {
    const double a = (run.v_m_s[i] - run.v_m_s[i - 1]) / kPeriod_s;
    const double before = (run.v_m_s[i - 1] - run.v_m_s[i - 2]) / kPeriod_s;
    ASSERT_LE(std::abs(a - before) / kPeriod_s, run.control.jerk_m_s3 + 1e-6);
    ASSERT_LE(std::abs(a), std::max(run.control.acceleration_m_s2, run.control.deceleration_m_s2) + 1e-9);
    accelerations += std::abs(a) > 0.3;
  }
  EXPECT_GT(accelerations, 500);
}

TEST(ComfortLimiter, ReachesTheWantedVelocityWithoutOvershoot) {
  for (const double wanted : {0.5, 0.01, -0.3, 0.0005}) {
    Limited run;
    const double fraction_m_s = 0.25 * run.control.jerk_m_s3 * kPeriod_s * kPeriod_s;  // of one step
    for (int i = 0; i < 150; ++i) {
      const double v = run.tick(wanted).v_m_s;
      ASSERT_LE(std::abs(v), std::abs(wanted) + fraction_m_s) << wanted;
      ASSERT_GE(v * wanted, 0.0);
    }
    EXPECT_NEAR(run.v_m_s.back(), wanted, 1e-9);
    for (int i = 0; i < 150; ++i) ASSERT_GE(run.tick(0.0).v_m_s * std::copysign(1.0, wanted), -fraction_m_s);
    EXPECT_NEAR(run.v_m_s.back(), 0.0, 1e-9);
  }
}

TEST(ComfortLimiter, GoesOnFromWhatTheGateLetThroughWithoutAJump) {
  Limited run;
  for (int i = 0; i < 100; ++i) run.tick(0.6);
  run.command.v_m_s = 0.2;  // the gate braked
  const double v = run.tick(0.6).v_m_s;
  EXPECT_NEAR(v, 0.2, run.control.jerk_m_s3 * kPeriod_s * kPeriod_s + 1e-9);
}

TEST(ComfortLimiter, ACommandThatHasExpiredIsRest) {
  Limited run;
  for (int i = 0; i < 100; ++i) run.tick(0.6, 0.5);
  run.now_ns += kNsPerS;
  const WantedVelocity out = run.tick(0.6, 0.5);
  EXPECT_EQ(out.v_m_s, 0.0);
  EXPECT_EQ(out.yaw_rate_rad_s, 0.0);
}

TEST(ComfortLimiter, LimitsTheYawRateToo) {
  Limited run;
  double before = 0.0, a_before = 0.0;
  for (int i = 0; i < 200; ++i) {
    const double rate = run.tick(0.0, i < 100 ? 1.0 : -1.0).yaw_rate_rad_s;
    const double a = (rate - before) / kPeriod_s;
    ASSERT_LE(std::abs(a), run.control.yaw_acceleration_rad_s2 + 1e-9);
    ASSERT_LE(std::abs(a - a_before) / kPeriod_s, run.control.yaw_jerk_rad_s3 + 1e-6);
    before = rate;
    a_before = a;
  }
  EXPECT_NEAR(before, -1.0, 1e-9);
}

TEST(ComfortLimiter, DoesNotGoBeyondTheGatesLimits) {
  Limited run;
  run.control.acceleration_m_s2 = 2.0;
  run.config.gate.acceleration_m_s2 = 0.4;
  run.limiter.reconfigure(run.config);
  double before = 0.0, most = 0.0;
  for (int i = 0; i < 60; ++i) {
    const double v = run.tick(0.6).v_m_s;
    most = std::max(most, (v - before) / kPeriod_s);
    before = v;
  }
  EXPECT_NEAR(most, 0.4, 1e-9);
}

TEST(ComfortLimiter, PassesOnWhatIsNotFinite) {
  Limited run;
  EXPECT_TRUE(std::isnan(run.tick(std::nan("")).v_m_s));
  run.command.v_m_s = 0.0;
  EXPECT_TRUE(std::isfinite(run.tick(0.5).v_m_s));
  EXPECT_TRUE(std::isinf(run.tick(0.5, INFINITY).yaw_rate_rad_s));
}

}  // namespace
}  // namespace heel
