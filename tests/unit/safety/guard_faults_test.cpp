// The guard with what it observes over several ticks: warmth, energy, travel, stillness, and the clutch. Each
// in closed form; ticks of 1 ms.

#include <gtest/gtest.h>

#include <functional>
#include <glm/geometric.hpp>
#include <limits>

#include "rt/allocation_guard.h"
#include "safety/force_guard.h"

namespace haptic::safety {
namespace {

constexpr double kDt = 0.001;
constexpr double kRounding = 1e-9;

/// Limits of which none acts, so that a test can turn on the one it is about.
GuardLimits no_limits() {
  return {.max_force = 1e6,
          .max_force_rate = 1e12,
          .max_speed = 1e6,
          .arm_ramp = 0.0,
          .max_sample_age = 1e6,
          .max_energy = kUnlimited};
}

/// A device with a new sample in each tick.
class Bench {
 public:
  explicit Bench(const GuardLimits& limits) : guard(limits) { guard.arm_at_once(); }

  GuardOutput tick() {
    input.tick = tick_;
    input.sample_time = static_cast<std::int64_t>(tick_) * 1'000'000;
    ++tick_;
    return guard.guard(input, kDt);
  }

  /// Ticks until force was zero, at most `most`.
  int ticks_until_zero(int most, const std::function<void()>& move) {
    for (int i = 0; i < most; ++i) {
      move();
      if (tick().force == glm::dvec3(0.0)) return i;
    }
    return most;
  }

  ForceGuard guard;
  GuardInput input{.device = 2, .present = true, .force = {2.0, 0.0, 0.0}};

 private:
  std::uint64_t tick_ = 0;
};

TEST(GuardFaults, TravelBeyondTheBoxCutsAndTellsTheSide) {
  GuardLimits limits = no_limits();
  limits.travel = {{-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1}};
  Bench bench(limits);
  bench.input.position = {5.0, 5.0, 5.0};  // in the world, which does not matter
  bench.input.place = {0.1, 0.0, 0.0};
  EXPECT_EQ(bench.tick().force.x, 2.0);
  bench.input.place.x = 0.101;
  EXPECT_EQ(bench.tick().force, glm::dvec3(0.0));
  EXPECT_EQ(bench.guard.fault().kind, FaultKind::kOverTravel);
  EXPECT_EQ(bench.guard.fault().device, 2U);
  EXPECT_EQ(bench.guard.fault().value, 0.101);
  EXPECT_EQ(bench.guard.fault().limit, 0.1);
}

TEST(GuardFaults, TravelIsNoFaultWhileDisarmed) {
  GuardLimits limits = no_limits();
  limits.travel = {{-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1}};
  Bench bench(limits);
  bench.guard.disarm();
  bench.input.place.x = 1.0;
  bench.tick();
  EXPECT_EQ(bench.guard.fault().kind, FaultKind::kNone);
}

// 2 N along a motion of 2^-9 m in each tick are 2^-8 J, exactly; the first tick gives a force that has moved
// nothing yet. 1 J is allowed: that is given after 256 ticks of motion, and more in the next.
TEST(GuardFaults, EnergyBeyondTheBoundCuts) {
  GuardLimits limits = no_limits();
  limits.max_energy = 1.0;
  Bench bench(limits);
  const int ticks = bench.ticks_until_zero(1000, [&] { bench.input.position.x += 0.001953125; });
  EXPECT_EQ(ticks, 257);
  EXPECT_EQ(bench.guard.fault().kind, FaultKind::kEnergy);
  EXPECT_EQ(bench.guard.fault().value, 1.00390625);
  EXPECT_EQ(bench.guard.fault().limit, 1.0);
}

TEST(GuardFaults, EnergyCountsFromArming) {
  GuardLimits limits = no_limits();
  limits.max_energy = 1.0;
  Bench bench(limits);
  for (int i = 0; i < 400; ++i, bench.input.position.x += 0.001) bench.tick();
  EXPECT_NEAR(bench.guard.energy(), 0.798, kRounding);
  bench.guard.disarm();
  bench.tick();
  EXPECT_NEAR(bench.guard.energy(), 0.798, kRounding) << "told until it is armed again";
  bench.guard.arm();
  EXPECT_EQ(bench.guard.energy(), 0.0);
}

TEST(GuardFaults, AForceThatTheHardwareDidNotHoldGivesNoEnergy) {
  GuardLimits limits = no_limits();
  limits.max_energy = 0.1;
  limits.max_still = 0.1;
  Bench moved(limits);
  moved.input.force_share = 0.0;
  for (int i = 0; i < 1000; ++i, moved.input.position.x += 0.001) moved.tick();
  EXPECT_EQ(moved.guard.energy(), 0.0);
  EXPECT_EQ(moved.guard.mean_force(), 0.0);
  Bench still(limits);
  still.input.force_share = 0.0;
  for (int i = 0; i < 1000; ++i) still.tick();
  EXPECT_EQ(still.guard.fault().kind, FaultKind::kNone);
}

// Force flows from tick 0 on, so that tick 1 is the first in which the position could have changed under it.
TEST(GuardFaults, ThePositionThatNeverChangesUnderForceIsAFaultAfterItsTime) {
  GuardLimits limits = no_limits();
  limits.max_still = 0.25;
  Bench bench(limits);
  const int ticks = bench.ticks_until_zero(1000, [] {});
  EXPECT_EQ(ticks, 251);  // 250 ms are allowed
  EXPECT_EQ(bench.guard.fault().kind, FaultKind::kStillSample);
  EXPECT_NEAR(bench.guard.fault().value, 0.251, kRounding);
  EXPECT_EQ(bench.guard.fault().limit, 0.25);
}

TEST(GuardFaults, StandingStillIsNoFaultByDefaultNorWithoutForce) {
  Bench by_default(no_limits());
  EXPECT_EQ(by_default.ticks_until_zero(100000, [] {}), 100000);
  GuardLimits limits = no_limits();
  limits.max_still = 0.25;
  Bench without_force(limits);
  without_force.input.force = {};
  for (int i = 0; i < 1000; ++i) without_force.tick();
  EXPECT_EQ(without_force.guard.fault().kind, FaultKind::kNone);
}

// 5 N wanted for ever, and 1 N allowed on the mean of 1 s: 5 N pass until the mean is 0.9 N, which is
// -ln(1 - 0.9 / 5) = 0.198 s, and 1 N in the end.
TEST(GuardFaults, WarmMotorsAreGivenLessWithoutAFault) {
  GuardLimits limits = no_limits();
  limits.max_force = 5.0;
  limits.max_mean_force = 1.0;
  limits.mean_force_time = 1.0;
  Bench bench(limits);
  bench.input.force = {0.0, 5.0, 0.0};
  bench.input.torque = {0.0, 0.0, 1.0};
  int full = 0;
  GuardOutput output = bench.tick();
  for (; output.limits == kLimitNone; ++full) output = bench.tick();
  EXPECT_NEAR(full, 198, 2);
  EXPECT_EQ(output.limits, kLimitMeanForce);
  for (int i = 0; i < 20000; ++i) {
    output = bench.tick();
    ASSERT_LE(bench.guard.mean_force(), 1.0);
  }
  EXPECT_NEAR(output.force.y, 1.0, 0.01);
  EXPECT_NEAR(output.torque.z, 0.2, 0.002) << "force and torque are scaled together";
  EXPECT_EQ(output.limits, kLimitMeanForce);
  EXPECT_EQ(bench.guard.fault().kind, FaultKind::kNone);
}

TEST(GuardFaults, MotorsStayWarmWhenTheyAreArmedAgain) {
  GuardLimits limits = no_limits();
  limits.max_mean_force = 1.0;
  limits.mean_force_time = 1.0;
  Bench bench(limits);
  for (int i = 0; i < 20000; ++i) bench.tick();
  const double warm = bench.guard.mean_force();
  bench.guard.latch({.kind = FaultKind::kMissedTicks});
  bench.guard.clear();
  bench.guard.arm_at_once();
  EXPECT_EQ(bench.guard.mean_force(), warm);
}

TEST(GuardFaults, TheClutchTakesForceAwayByTheSlewLimitAndItRampsUpAfterwards) {
  GuardLimits limits = no_limits();
  limits.max_force_rate = 500.0;  // 0.5 N in a tick
  limits.arm_ramp = 0.1;          // 100 ticks
  Bench bench(limits);
  for (int i = 0; i < 10; ++i) bench.tick();
  bench.input.clutched = true;
  for (const double left : {1.5, 1.0, 0.5, 0.0, 0.0}) {
    const GuardOutput output = bench.tick();
    EXPECT_NEAR(output.force.x, left, kRounding);
    EXPECT_NE(output.limits & kLimitClutch, 0U);
  }
  bench.input.clutched = false;
  for (int tick = 1; tick <= 100; ++tick) EXPECT_NEAR(bench.tick().force.x, 2.0 * tick / 100.0, kRounding);
  EXPECT_TRUE(bench.guard.armed());
}

TEST(GuardFaults, APlaceThatIsNoNumberIsAFault) {
  Bench bench(no_limits());
  bench.input.place.y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(bench.tick().force, glm::dvec3(0.0));
  EXPECT_EQ(bench.guard.fault().kind, FaultKind::kNotFinite);
}

TEST(GuardFaults, ObservingIsRealTimeSafe) {
  GuardLimits limits;
  limits.max_mean_force = 0.1;
  limits.max_still = 0.5;
  limits.travel = {{-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0}};
  Bench bench(limits);
  const rt::AllocationGuard watch;
  for (int i = 0; i < 1000; ++i) {
    bench.input.clutched = i % 200 > 190;
    bench.input.position.x = bench.input.place.x = i * 0.0001;
    bench.tick();
  }
}

}  // namespace
}  // namespace haptic::safety
