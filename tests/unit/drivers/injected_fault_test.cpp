#include "drivers/simulated/injected_fault.h"

#include <gtest/gtest.h>

#include <cmath>

#include "drivers/simulated/simulated_device.h"
#include "rt/allocation_guard.h"

namespace haptic::drivers {
namespace {

constexpr Nanoseconds kMillisecond = 1'000'000;

/// At tick n of 1 kHz the device is at x = n mm and moves by 1 m/s.
DeviceSample at_tick(int n) {
  return {.time = n * kMillisecond, .position = {n * 1e-3, 0.0, 0.0}, .velocity = {1.0, 0.0, 0.0}};
}

class Injection : public testing::Test {
 protected:
  explicit Injection(const InjectedFault& fault = {}) { inject(fault); }

  void inject(const InjectedFault& fault) {
    injector_ = FaultInjector(std::span(&fault, 1));
    injector_.start();
    next_ = 0;
  }

  /// What becomes of the next tick's sample; none if it is lost.
  std::optional<DeviceSample> next() {
    DeviceSample sample = at_tick(next_);
    const bool arrives = injector_.pass(next_ * kMillisecond, sample);
    ++next_;
    return arrives ? std::optional(sample) : std::nullopt;
  }

  std::optional<DeviceSample> at(int tick) {
    while (next_ < tick) next();
    return next();
  }

  FaultInjector injector_{{}};
  int next_ = 0;
};

TEST_F(Injection, DropsTheSamplesOfItsTimeAndNoOthers) {
  inject({.kind = InjectedKind::kDrop, .at = 0.010, .duration = 0.005});
  EXPECT_TRUE(at(9));
  for (int tick = 10; tick < 15; ++tick) {
    EXPECT_FALSE(at(tick)) << tick;
    EXPECT_FALSE(injector_.is_unplugged());
  }
  EXPECT_TRUE(at(15));
}

TEST_F(Injection, LastsForEverUnlessItHasADuration) {
  inject({.kind = InjectedKind::kUnplug, .at = 0.010});
  EXPECT_TRUE(at(9));
  EXPECT_FALSE(injector_.is_unplugged());
  EXPECT_FALSE(at(10));
  EXPECT_TRUE(injector_.is_unplugged());
  EXPECT_FALSE(at(100'000));
}

TEST_F(Injection, ADelayedSampleIsTheOneOfThatTimeBeforeWithItsOwnTime) {
  inject({.kind = InjectedKind::kDelay, .at = 0.010, .duration = 0.010, .delay = 0.004});
  EXPECT_EQ(at(9)->time, 9 * kMillisecond);
  for (int tick = 10; tick < 20; ++tick) {
    const auto sample = at(tick);
    ASSERT_TRUE(sample);
    EXPECT_EQ(sample->time, (tick - 4) * kMillisecond);
    EXPECT_EQ(sample->position, at_tick(tick - 4).position);
  }
  EXPECT_EQ(at(20)->time, 20 * kMillisecond);
}

TEST_F(Injection, ThereIsNoSampleFromBeforeTheStart) {
  inject({.kind = InjectedKind::kDelay, .at = 0.0, .delay = 0.004});
  for (int tick = 0; tick < 4; ++tick) EXPECT_FALSE(at(tick)) << tick;
  EXPECT_EQ(at(4)->time, 0);
}

TEST_F(Injection, KeepsEnoughForTheLongestDelayLongAfterTheStart) {
  inject({.kind = InjectedKind::kDelay, .at = 20.0, .delay = kLongestDelay});
  EXPECT_EQ(at(20'000)->time, 19'000 * kMillisecond);
}

TEST_F(Injection, AFrozenPoseRestsAndStillLooksNew) {
  inject({.kind = InjectedKind::kFreeze, .at = 0.010, .duration = 0.010});
  for (int tick = 10; tick < 20; ++tick) {
    const auto sample = at(tick);
    EXPECT_EQ(sample->time, tick * kMillisecond);
    EXPECT_EQ(sample->position, at_tick(10).position);
    EXPECT_EQ(sample->velocity, glm::dvec3(0.0));
  }
  EXPECT_EQ(at(20)->position, at_tick(20).position);
}

TEST_F(Injection, APositionIsNoNumberWhenAsked) {
  inject({.kind = InjectedKind::kNotANumber, .at = 0.010, .duration = 0.001});
  EXPECT_FALSE(std::isnan(at(9)->position.x));
  EXPECT_TRUE(std::isnan(at(10)->position.x));
  EXPECT_FALSE(std::isnan(at(11)->position.x));
}

// 30 mm within 1 ms are 30 m/s, there and back.
TEST_F(Injection, AJumpShowsInTheVelocityOfTheSampleInWhichItComesAndGoes) {
  inject({.kind = InjectedKind::kJump, .at = 0.010, .duration = 0.005, .offset = {0.03, 0.0, 0.0}});
  EXPECT_EQ(at(9)->position, at_tick(9).position);
  const auto first = at(10);
  EXPECT_NEAR(first->position.x, 0.04, 1e-12);
  EXPECT_NEAR(first->velocity.x, 31.0, 1e-9);
  const auto second = at(11);
  EXPECT_NEAR(second->position.x, 0.041, 1e-12);
  EXPECT_EQ(second->velocity.x, 1.0);
  EXPECT_NEAR(at(15)->velocity.x, -29.0, 1e-9);
  EXPECT_EQ(at(16)->position, at_tick(16).position);
}

TEST_F(Injection, SeveralFaultsGoTogether) {
  const InjectedFault faults[] = {{.kind = InjectedKind::kFreeze, .at = 0.010},
                                  {.kind = InjectedKind::kDrop, .at = 0.012, .duration = 0.001}};
  injector_ = FaultInjector(faults);
  EXPECT_EQ(at(11)->position, at_tick(10).position);
  EXPECT_FALSE(at(12));
  EXPECT_EQ(at(13)->position, at_tick(10).position);
}

TEST_F(Injection, IsRealTimeSafe) {
  inject({.kind = InjectedKind::kDelay, .at = 0.5, .delay = 0.5});
  const rt::AllocationGuard watch;
  at(2000);
}

// Without its sample the servo does not write less: only the force that arrives is another.
TEST(InjectedFaults, AnUnpluggedDeviceFeelsNoForceAndOneWhoseSamplesAreLostDoes) {
  const auto moved = [](InjectedKind kind) {
    SimulatedDevice device(
        {.name = "left", .mass = 0.1, .faults = {{.kind = kind, .at = 0.0, .duration = 0.100}}});
    device.start();
    DeviceSample sample;
    for (int tick = 0; tick <= 100; ++tick) {
      device.read(tick * kMillisecond, sample);
      device.write(tick * kMillisecond, {.expires = (tick + 3) * kMillisecond, .force = {1.0, 0.0, 0.0}});
    }
    return sample.position.x;
  };
  // F t^2 / (2 m) = 50 mm
  EXPECT_NEAR(moved(InjectedKind::kDrop), 0.05, 0.0005);
  EXPECT_EQ(moved(InjectedKind::kUnplug), 0.0);
}

// The servo takes what is in a sample for measured, unless there is none.
TEST(InjectedFaults, ASampleThatIsLostLeavesTheFormerOneAlone) {
  SimulatedDevice device({.name = "left", .faults = {{.kind = InjectedKind::kDrop, .at = 0.001}}});
  device.start();
  DeviceSample sample;
  ASSERT_TRUE(device.read(0, sample));
  EXPECT_FALSE(device.read(5 * kMillisecond, sample));
  EXPECT_EQ(sample.time, 0);
}

}  // namespace
}  // namespace haptic::drivers
