#include "safety/force_guard.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <random>

#include "rt/allocation_guard.h"

namespace haptic::safety {
namespace {

constexpr double kDt = 0.001;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kRounding = 1e-12;

/// Limits of which none acts, so that a test can turn on the one it is about.
GuardLimits no_limits() {
  return {.max_force = 1e6, .max_force_rate = 1e12, .max_speed = 1e6, .arm_ramp = 0.0, .max_sample_age = 1e6};
}

GuardInput input_with(const glm::dvec3& force) {
  return {.tick = 42, .device = 3, .present = true, .force = force};
}

ForceGuard armed_guard(const GuardLimits& limits) {
  ForceGuard guard(limits);
  guard.arm_at_once();
  return guard;
}

void expect_zero(const GuardOutput& output) {
  EXPECT_EQ(output.force, glm::dvec3(0.0));
  EXPECT_EQ(output.torque, glm::dvec3(0.0));
}

TEST(ForceGuard, LetsNothingThroughUnlessArmed) {
  ForceGuard guard(no_limits());
  expect_zero(guard.guard(input_with({1.0, 2.0, 3.0}), kDt));
  EXPECT_FALSE(guard.armed());
}

TEST(ForceGuard, LetsAForceWithinAllLimitsThroughAsItIs) {
  ForceGuard guard = armed_guard(no_limits());
  GuardInput input = input_with({1.0, -2.0, 3.0});
  input.torque = {0.1, 0.2, -0.3};
  const GuardOutput output = guard.guard(input, kDt);
  EXPECT_EQ(output.force, input.force);
  EXPECT_EQ(output.torque, input.torque);
  EXPECT_EQ(output.limits, kLimitNone);
}

TEST(ForceGuard, ClampsTheMagnitudeAndKeepsTheDirection) {
  GuardLimits limits = no_limits();
  limits.max_force = 5.0;
  ForceGuard guard = armed_guard(limits);
  GuardInput input = input_with({6.0, 0.0, 8.0});  // 10 N: half is let through
  input.torque = {0.0, 2.0, 0.0};
  const GuardOutput output = guard.guard(input, kDt);
  EXPECT_NEAR(glm::distance(output.force, glm::dvec3(3.0, 0.0, 4.0)), 0.0, kRounding);
  EXPECT_NEAR(glm::distance(output.torque, glm::dvec3(0.0, 1.0, 0.0)), 0.0, kRounding);
  EXPECT_EQ(output.limits, kLimitForce);
}

TEST(ForceGuard, ClampsForcesWhoseSquareIsBeyondADouble) {
  GuardLimits limits = no_limits();
  limits.max_force = 5.0;
  for (const double huge : {1e160, 1e300, std::numeric_limits<double>::max()}) {
    ForceGuard guard = armed_guard(limits);
    const GuardOutput output = guard.guard(input_with({huge, huge, huge}), kDt);
    EXPECT_NEAR(glm::distance(output.force, glm::dvec3(5.0 / std::sqrt(3.0))), 0.0, kRounding);
  }
}

TEST(ForceGuard, LimitsTheMagnitudeOfTheChangeInEveryDirection) {
  GuardLimits limits = no_limits();
  limits.max_force_rate = 500.0;  // 0.5 N in a tick
  ForceGuard guard = armed_guard(limits);
  GuardOutput output = guard.guard(input_with({3.0, 4.0, 0.0}), kDt);
  EXPECT_NEAR(glm::distance(output.force, glm::dvec3(0.3, 0.4, 0.0)), 0.0, kRounding);
  EXPECT_EQ(output.limits, kLimitRate);
  // 5 N take ten ticks; the tenth arrives
  for (int tick = 1; tick < 10; ++tick) output = guard.guard(input_with({3.0, 4.0, 0.0}), kDt);
  EXPECT_NEAR(glm::distance(output.force, glm::dvec3(3.0, 4.0, 0.0)), 0.0, kRounding);
  // turning the force changes it too, though its magnitude stays: (3,4) to (-3,-4) is 10 N away
  output = guard.guard(input_with({-3.0, -4.0, 0.0}), kDt);
  EXPECT_NEAR(glm::distance(output.force, glm::dvec3(2.7, 3.6, 0.0)), 0.0, kRounding);
}

TEST(ForceGuard, RampsUpAfterArming) {
  GuardLimits limits = no_limits();
  limits.arm_ramp = 0.5;  // 500 ticks
  ForceGuard guard(limits);
  ASSERT_TRUE(guard.arm());
  for (int tick = 1; tick <= 600; ++tick) {
    const GuardOutput output = guard.guard(input_with({2.0, 0.0, 0.0}), kDt);
    EXPECT_NEAR(output.force.x, 2.0 * std::min(1.0, tick / 500.0), 1e-9) << "tick " << tick;
    if (tick < 499) {
      EXPECT_EQ(output.limits, kLimitRamp);
    }
    if (tick > 501) {
      EXPECT_EQ(output.limits, kLimitNone);
    }
  }
}

TEST(ForceGuard, ArmingWhileArmedDoesNotRampAgain) {
  GuardLimits limits = no_limits();
  limits.arm_ramp = 0.5;
  ForceGuard guard = armed_guard(limits);
  EXPECT_TRUE(guard.arm());
  EXPECT_EQ(guard.guard(input_with({2.0, 0.0, 0.0}), kDt).force.x, 2.0);
}

TEST(ForceGuard, DisarmingRampsDownByTheSlewLimit) {
  GuardLimits limits = no_limits();
  limits.max_force_rate = 500.0;
  ForceGuard guard = armed_guard(limits);
  const GuardInput input = input_with({2.0, 0.0, 0.0});
  for (int tick = 0; tick < 4; ++tick) guard.guard(input, kDt);
  guard.disarm();
  for (int tick = 1; tick <= 4; ++tick) {
    EXPECT_NEAR(guard.guard(input, kDt).force.x, 2.0 - 0.5 * tick, kRounding);
  }
  expect_zero(guard.guard(input, kDt));
}

TEST(ForceGuard, ArmingAgainRampsFromNothing) {
  GuardLimits limits = no_limits();
  limits.arm_ramp = 0.5;
  ForceGuard guard = armed_guard(limits);
  guard.disarm();
  guard.guard(input_with({2.0, 0.0, 0.0}), kDt);
  ASSERT_TRUE(guard.arm());
  EXPECT_NEAR(guard.guard(input_with({2.0, 0.0, 0.0}), kDt).force.x, 2.0 / 500.0, kRounding);
}

TEST(ForceGuard, OverSpeedIsAFaultThatCutsAtOnce) {
  GuardLimits limits = no_limits();
  limits.max_speed = 2.0;
  limits.max_force_rate = 500.0;
  ForceGuard guard = armed_guard(limits);
  GuardInput input = input_with({2.0, 0.0, 0.0});
  for (int tick = 0; tick < 4; ++tick) guard.guard(input, kDt);
  input.velocity = {0.0, 1.2, 1.6};  // exactly 2 m/s is allowed
  EXPECT_EQ(guard.guard(input, kDt).force.x, 2.0);
  input.velocity = {0.0, 1.5, 2.0};
  expect_zero(guard.guard(input, kDt));
  EXPECT_EQ(guard.fault().kind, FaultKind::kOverSpeed);
  EXPECT_DOUBLE_EQ(guard.fault().value, 2.5);
  EXPECT_EQ(guard.fault().limit, 2.0);
  EXPECT_EQ(guard.fault().device, 3u);
  EXPECT_EQ(guard.fault().tick, 42u);
  EXPECT_FALSE(guard.armed());
}

TEST(ForceGuard, AStaleSampleIsAFault) {
  GuardLimits limits = no_limits();
  limits.max_sample_age = 0.02;
  ForceGuard guard = armed_guard(limits);
  GuardInput input = input_with({2.0, 0.0, 0.0});
  input.sample_age = 0.02;
  EXPECT_EQ(guard.guard(input, kDt).force.x, 2.0);
  input.sample_age = 0.021;
  expect_zero(guard.guard(input, kDt));
  EXPECT_EQ(guard.fault().kind, FaultKind::kStaleSample);
  EXPECT_EQ(guard.fault().value, 0.021);
  EXPECT_EQ(guard.fault().limit, 0.02);
}

TEST(ForceGuard, SpeedAndAgeAreNoFaultsWhileDisarmed) {
  GuardLimits limits = no_limits();
  limits.max_speed = 2.0;
  limits.max_sample_age = 0.02;
  ForceGuard guard(limits);
  GuardInput input = input_with({2.0, 0.0, 0.0});
  input.velocity.x = 100.0;
  input.sample_age = 100.0;
  expect_zero(guard.guard(input, kDt));
  EXPECT_EQ(guard.fault().kind, FaultKind::kNone);
}

TEST(ForceGuard, WhatIsNoNumberIsAFaultArmedOrNot) {
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    for (int axis = 0; axis < 3; ++axis) {
      for (glm::dvec3 GuardInput::*member :
           {&GuardInput::position, &GuardInput::velocity, &GuardInput::force, &GuardInput::torque}) {
        for (const bool armed : {true, false}) {
          ForceGuard guard(no_limits());
          if (armed) guard.arm_at_once();
          GuardInput input = input_with({2.0, 0.0, 0.0});
          (input.*member)[axis] = bad;
          expect_zero(guard.guard(input, kDt));
          EXPECT_EQ(guard.fault().kind, FaultKind::kNotFinite);
        }
      }
    }
  }
}

TEST(ForceGuard, AnOrientationThatIsNoNumberIsAFault) {
  ForceGuard guard = armed_guard(no_limits());
  GuardInput input = input_with({2.0, 0.0, 0.0});
  input.orientation.y = kNan;
  expect_zero(guard.guard(input, kDt));
  EXPECT_EQ(guard.fault().kind, FaultKind::kNotFinite);
}

TEST(ForceGuard, AFaultStaysUntilItIsClearedAndThenStaysDisarmed) {
  ForceGuard guard = armed_guard(no_limits());
  guard.guard(input_with({kNan, 0.0, 0.0}), kDt);
  EXPECT_FALSE(guard.arm());
  guard.arm_at_once();
  expect_zero(guard.guard(input_with({1.0, 0.0, 0.0}), kDt));
  guard.clear();
  EXPECT_EQ(guard.fault().kind, FaultKind::kNone);
  expect_zero(guard.guard(input_with({1.0, 0.0, 0.0}), kDt));
  EXPECT_TRUE(guard.arm());
  EXPECT_EQ(guard.guard(input_with({1.0, 0.0, 0.0}), kDt).force.x, 1.0);
}

TEST(ForceGuard, KeepsTheFirstFault) {
  ForceGuard guard = armed_guard(no_limits());
  guard.latch({.kind = FaultKind::kMissedTicks, .tick = 7, .value = 51.0, .limit = 50.0});
  expect_zero(guard.guard(input_with({kNan, 0.0, 0.0}), kDt));
  EXPECT_EQ(guard.fault().kind, FaultKind::kMissedTicks);
  EXPECT_EQ(guard.fault().tick, 7u);
  EXPECT_EQ(guard.fault().device, kNoDevice);
}

TEST(ForceGuard, AGentleFaultBringsForceDownByTheSlewLimitAndStaysLatched) {
  GuardLimits limits = no_limits();
  limits.max_force_rate = 250.0;  // 0.25 N in a tick of 1 ms
  ForceGuard guard(limits);
  guard.arm_at_once();
  for (int i = 0; i < 10; ++i) guard.guard(input_with({1.0, 0.0, 0.0}), kDt);
  guard.latch_gently({.kind = FaultKind::kLostDriver, .tick = 7});
  EXPECT_FALSE(guard.is_cut());
  for (const double left : {0.75, 0.5, 0.25, 0.0, 0.0}) {
    EXPECT_NEAR(guard.guard(input_with({1.0, 0.0, 0.0}), kDt).force.x, left, kRounding);
  }
  EXPECT_EQ(guard.fault().kind, FaultKind::kLostDriver);
  EXPECT_FALSE(guard.arm());
}

TEST(ForceGuard, AFaultThatComesWhileForceGoesDownCutsIt) {
  GuardLimits limits = no_limits();
  limits.max_force_rate = 250.0;
  ForceGuard guard(limits);
  guard.arm_at_once();
  for (int i = 0; i < 10; ++i) guard.guard(input_with({1.0, 0.0, 0.0}), kDt);
  guard.latch_gently({.kind = FaultKind::kLostDriver, .tick = 7});
  expect_zero(guard.guard(input_with({kNan, 0.0, 0.0}), kDt));
  EXPECT_TRUE(guard.is_cut());
  EXPECT_EQ(guard.fault().kind, FaultKind::kLostDriver);
  guard.clear();
  EXPECT_FALSE(guard.is_cut());
}

TEST(ForceGuard, ADeviceWithoutASampleGetsNothingAndRampsUpOnceItHasOne) {
  GuardLimits limits = no_limits();
  limits.arm_ramp = 0.5;
  ForceGuard guard = armed_guard(limits);
  GuardInput input = input_with({2.0, 0.0, 0.0});
  input.present = false;
  expect_zero(guard.guard(input, kDt));
  EXPECT_EQ(guard.fault().kind, FaultKind::kNone);
  input.present = true;
  EXPECT_NEAR(guard.guard(input, kDt).force.x, 2.0 / 500.0, kRounding);
}

// Whatever comes in, and whatever is switched meanwhile: what goes out is finite, within max_force, and
// changes by no more than max_force_rate dt but for a cut to zero by a fault or a lost sample.
TEST(ForceGuard, NeverBreaksItsBoundsForAnyInput) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::uniform_int_distribution<int> dice(0, 999);
  const auto wild = [&](double usual) {
    const int d = dice(random);
    if (d == 0) return kNan;
    if (d == 1) return kInfinity;
    if (d < 10) return unit(random) * 1e300;
    if (d < 20) return unit(random) * 1e-310;
    return unit(random) * usual;
  };
  const auto wild_vector = [&](double usual) { return glm::dvec3(wild(usual), wild(usual), wild(usual)); };

  const GuardLimits limits;
  ForceGuard guard(limits);
  glm::dvec3 last(0.0);
  int forced = 0;
  for (int tick = 0; tick < 200000; ++tick) {
    const int d = dice(random);
    if (d < 20) guard.arm();
    if (d == 20) guard.arm_at_once();
    if (d == 21) guard.disarm();
    if (d == 22) guard.restart_ramp();
    if (d > 22 && d < 60) guard.clear();
    GuardInput input;
    input.tick = static_cast<std::uint64_t>(tick);
    input.present = dice(random) > 2;
    input.sample_age = std::abs(unit(random)) * 0.0201;
    input.position = glm::dvec3(unit(random));
    input.velocity = dice(random) < 5 ? wild_vector(1.0) : glm::dvec3(unit(random), 0.0, 0.0);
    input.force = dice(random) < 100 ? wild_vector(20.0) : glm::dvec3(4.0, unit(random), 0.0);
    input.torque = glm::dvec3(unit(random));
    const GuardOutput output = guard.guard(input, kDt);
    const double magnitude = glm::length(output.force);
    ASSERT_TRUE(std::isfinite(magnitude) && std::isfinite(glm::length(output.torque)));
    ASSERT_LE(magnitude, limits.max_force * (1.0 + kRounding));
    const bool cut = guard.fault().kind != FaultKind::kNone || !input.present;
    if (cut) {
      ASSERT_EQ(magnitude, 0.0);
    } else {
      ASSERT_LE(glm::distance(output.force, last), limits.max_force_rate * kDt * (1.0 + kRounding));
    }
    forced += magnitude > 0.5 ? 1 : 0;
    last = output.force;
  }
  EXPECT_GT(forced, 1000) << "the test must not only see zeros";
}

TEST(ForceGuard, IsRealTimeSafe) {
  ForceGuard guard(GuardLimits{});
  const rt::AllocationGuard watch;
  guard.arm();
  guard.guard(input_with({1.0, 2.0, 3.0}), kDt);
  guard.guard(input_with({kNan, 2.0, 3.0}), kDt);
  guard.clear();
}

}  // namespace
}  // namespace haptic::safety
