#include "drivers/simulated/simulated_device.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "rt/allocation_guard.h"

namespace haptic::drivers {
namespace {

constexpr Nanoseconds kMillisecond = 1'000'000;
constexpr Nanoseconds kSecond = 1000 * kMillisecond;

/// Reads and writes at 1 kHz from `from` up to and with `to`; the force is written afresh in each tick.
DeviceSample run(SimulatedDevice& device, Nanoseconds from, Nanoseconds to, const glm::dvec3& force) {
  DeviceSample sample;
  for (Nanoseconds now = from; now <= to; now += kMillisecond) {
    EXPECT_TRUE(device.read(now, sample));
    device.write(now, {.expires = now + 3 * kMillisecond, .force = force});
  }
  return sample;
}

SimulatedSettings held_still() {
  return {.name = "left", .mass = 0.1, .damping = 1.0, .hand_stiffness = 300.0, .hand_damping = 3.0};
}

TEST(SimulatedDevice, HasNoSampleUntilStartedAndAfterStopped) {
  SimulatedDevice device(held_still());
  DeviceSample sample;
  EXPECT_FALSE(device.read(0, sample));
  device.start();
  EXPECT_TRUE(device.read(0, sample));
  device.stop();
  EXPECT_FALSE(device.read(kMillisecond, sample));
}

TEST(SimulatedDevice, BeginsAtRestWhereThePathBegins) {
  SimulatedSettings settings = held_still();
  settings.path = {{.time = 0.0, .position = {0.1, 0.2, 0.3}}, {.time = 1.0, .position = {1.0, 1.0, 1.0}}};
  SimulatedDevice device(settings);
  device.start();
  DeviceSample sample;
  ASSERT_TRUE(device.read(77 * kSecond, sample));
  EXPECT_EQ(sample.position, glm::dvec3(0.1, 0.2, 0.3));
  EXPECT_EQ(sample.velocity, glm::dvec3(0.0));
  EXPECT_EQ(sample.time, 77 * kSecond);
}

// At rest the spring balances the force: x = F / k.
TEST(SimulatedDevice, AForcePushesItAwayFromTheHandByForceOverStiffness) {
  SimulatedDevice device(held_still());
  device.start();
  const DeviceSample sample = run(device, 0, 3 * kSecond, {3.0, 0.0, -1.5});
  EXPECT_NEAR(glm::distance(sample.position, glm::dvec3(0.01, 0.0, -0.005)), 0.0, 1e-9);
  EXPECT_NEAR(glm::length(sample.velocity), 0.0, 1e-9);
}

// Without a hand m v' = F - d v, so v(t) = F/d (1 - exp(-d t / m)) and x(t) = F/d (t - m/d (1 - exp(-d
// t/m))).
TEST(SimulatedDevice, WithoutAHandItMovesAsTheEquationOfMotionSays) {
  SimulatedDevice device({.name = "free", .mass = 0.1, .damping = 1.0});
  device.start();
  const DeviceSample sample = run(device, 0, 100 * kMillisecond, {1.0, 0.0, 0.0});
  const double decay = std::exp(-1.0);  // after t = m/d = 0.1 s
  EXPECT_NEAR(sample.velocity.x, 1.0 - decay, 1e-3);
  EXPECT_NEAR(sample.position.x, 0.1 - 0.1 * (1.0 - decay), 1e-4);
}

// A mass on a spring that is let go at x0 is at x0 cos(w t) with w = sqrt(k/m): back at x0 after one period.
// Each step of h damps by w h / 2 of critical, which takes exp(-2 pi w h / 2) off a period: 3.1e-3 at w = 10,
// h = 1e-4.
TEST(SimulatedDevice, SwingsWithTheFrequencyOfItsMassAndTheHandsSpring) {
  SimulatedSettings settings{.name = "swing", .mass = 1.0, .hand_stiffness = 100.0};
  settings.path = {{.time = 0.0, .position = {0.0, 0.0, 0.0}}, {.time = 1e-4, .position = {-1.0, 0.0, 0.0}}};
  SimulatedDevice device(settings);
  device.start();
  const double period = 2.0 * std::acos(-1.0) / 10.0;
  const auto half = static_cast<Nanoseconds>(period / 2.0 * 1e9);
  DeviceSample sample;
  ASSERT_TRUE(device.read(0, sample));
  for (Nanoseconds now = 0; now < half; now += kMillisecond) ASSERT_TRUE(device.read(now, sample));
  ASSERT_TRUE(device.read(half, sample));
  EXPECT_NEAR(sample.position.x, -2.0, 0.01);
  for (Nanoseconds now = half; now < 2 * half; now += kMillisecond) ASSERT_TRUE(device.read(now, sample));
  ASSERT_TRUE(device.read(2 * half, sample));
  EXPECT_NEAR(sample.position.x, 0.0, 0.01);
}

TEST(SimulatedDevice, FollowsTheHand) {
  SimulatedSettings settings = held_still();
  settings.path = {{.time = 0.0, .position = {0.0, 0.0, 0.0}}, {.time = 1.0, .position = {0.1, 0.0, 0.0}}};
  SimulatedDevice device(settings);
  device.start();
  // steadily drawn at 0.1 m/s it lags by what its damping needs: d v / k = 1/3 mm
  const DeviceSample moving = run(device, 0, kSecond - kMillisecond, glm::dvec3(0.0));
  EXPECT_NEAR(moving.position.x, 0.0999 - 1.0 * 0.1 / 300.0, 1e-6);
  EXPECT_NEAR(moving.velocity.x, 0.1, 1e-6);
  const DeviceSample there = run(device, kSecond, 3 * kSecond, glm::dvec3(0.0));
  EXPECT_NEAR(there.position.x, 0.1, 1e-9);
}

TEST(SimulatedDevice, AnExpiredForceCountsAsZero) {
  SimulatedDevice renewed(held_still());
  SimulatedDevice forgotten(held_still());
  renewed.start();
  forgotten.start();
  run(renewed, 0, kSecond, {3.0, 0.0, 0.0});
  run(forgotten, 0, kSecond, {3.0, 0.0, 0.0});
  // nobody writes any more
  DeviceSample sample;
  for (Nanoseconds now = kSecond; now <= 3 * kSecond; now += kMillisecond) {
    ASSERT_TRUE(forgotten.read(now, sample));
  }
  EXPECT_NEAR(glm::length(sample.position), 0.0, 1e-9);
}

TEST(SimulatedDevice, AForceActsUntilTheMomentItExpires) {
  // a free mass under 1 N for 3 of 10 ms: v = F t / m
  SimulatedDevice device({.name = "free", .mass = 0.1});
  device.start();
  DeviceSample sample;
  ASSERT_TRUE(device.read(0, sample));
  device.write(0, {.expires = 3 * kMillisecond, .force = {1.0, 0.0, 0.0}});
  ASSERT_TRUE(device.read(10 * kMillisecond, sample));
  EXPECT_NEAR(sample.velocity.x, 1.0 * 0.003 / 0.1, 1e-9);
}

TEST(SimulatedDevice, GivesEqualBitsForEqualTimesWhateverTheClocksOrigin) {
  const auto last = [](Nanoseconds start) {
    SimulatedSettings settings = held_still();
    settings.path = {{.time = 0.0, .position = {0.0, 0.0, 0.0}}, {.time = 0.7, .position = {0.1, 0.2, 0.3}}};
    settings.repeat = true;
    SimulatedDevice device(settings);
    device.start();
    return run(device, start, start + 2 * kSecond, {0.3, -0.7, 0.1});
  };
  const DeviceSample a = last(0);
  const DeviceSample b = last(123'456'789'012'345);
  EXPECT_EQ(a.position, b.position);
  EXPECT_EQ(a.velocity, b.velocity);
}

TEST(SimulatedDevice, StaysFiniteForAnyMassDampingStiffnessAndGap) {
  for (const double mass : {1e-9, 1e-3, 1.0, 1e6}) {
    for (const double damping : {0.0, 1.0, 1e9}) {
      for (const double stiffness : {0.0, 300.0, 1e12}) {
        for (const Nanoseconds gap : {kMillisecond / 8, kMillisecond, 40 * kMillisecond, 3600 * kSecond}) {
          SimulatedSettings settings{.name = "odd",
                                     .mass = mass,
                                     .damping = damping,
                                     .hand_stiffness = stiffness,
                                     .hand_damping = damping};
          settings.path = {{.time = 0.0}, {.time = 0.01, .position = {0.01, 0.0, 0.0}}};
          SimulatedDevice device(settings);
          device.start();
          DeviceSample sample;
          for (int tick = 0; tick < 100; ++tick) ASSERT_TRUE(device.read(tick * gap, sample));
          EXPECT_TRUE(std::isfinite(glm::length(sample.position)));
          // a hand that holds it keeps it near: within three times the way the hand went
          if (stiffness > 0.0) {
            EXPECT_LT(glm::length(sample.position), 0.03);
          }
        }
      }
    }
  }
}

TEST(SimulatedDevice, TimeThatStandsStillOrGoesBackMovesNothing) {
  SimulatedDevice device(held_still());
  device.start();
  const DeviceSample before = run(device, 0, 50 * kMillisecond, {1.0, 0.0, 0.0});
  DeviceSample after;
  ASSERT_TRUE(device.read(50 * kMillisecond, after));
  EXPECT_EQ(after.position, before.position);
  ASSERT_TRUE(device.read(20 * kMillisecond, after));
  EXPECT_EQ(after.position, before.position);
}

TEST(SimulatedDevice, IsRealTimeSafe) {
  SimulatedSettings settings = held_still();
  settings.path = {{.time = 0.0}, {.time = 0.3, .position = {0.1, 0.0, 0.0}}};
  settings.repeat = true;
  SimulatedDevice device(settings);
  device.start();
  DeviceSample sample;
  const rt::AllocationGuard watch;
  for (Nanoseconds now = 0; now < kSecond; now += kMillisecond) {
    device.read(now, sample);
    device.write(now, {.expires = now + kMillisecond, .force = {1.0, 0.0, 0.0}});
  }
}

}  // namespace
}  // namespace haptic::drivers
