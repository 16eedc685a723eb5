// What the guard makes of each fault of a device: a simulated one stands still 10 mm deep in a wall, feels 1
// N, and fails at tick 100. Told are the ticks until its force is zero, counted from the one that fails, and
// what is latched.

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <string>

#include "drivers/simulated/simulated_device.h"
#include "tests/support/servo_rig.h"

namespace haptic::servo {
namespace {

using drivers::InjectedFault;
using drivers::InjectedKind;

constexpr std::uint64_t kFailsAt = 100;
constexpr double kFailsAfter = 0.1;  // s

/// Remembers what the servo wrote.
class Watched final : public drivers::Device {
 public:
  explicit Watched(drivers::SimulatedSettings settings) : device_(std::move(settings)) {}

  const drivers::DeviceInfo& info() const noexcept override { return device_.info(); }
  void start() override { device_.start(); }
  void stop() noexcept override { device_.stop(); }
  bool read(drivers::Nanoseconds now, drivers::DeviceSample& sample) noexcept override {
    return device_.read(now, sample);
  }
  void write(drivers::Nanoseconds now, const drivers::ForceCommand& command) noexcept override {
    written = command;
    device_.write(now, command);
  }

  drivers::ForceCommand written;

 private:
  drivers::SimulatedDevice device_;
};

struct Outcome {
  std::optional<std::uint64_t> ticks_until_zero;  // none: it never was within a second
  safety::Fault fault;
  double largest_after = 0.0;  // N, from the tick that fails on
};

// held so stiffly, and so heavy, that 1 N does not move it
drivers::SimulatedSettings held_in_the_wall(const InjectedFault& fault) {
  return {.name = "a",
          .mass = 1000.0,
          .hand_stiffness = 1e6,
          .hand_damping = 1e6,
          .path = {{.time = 0.0, .position = {0.01, 0.02, 0.005}},
                   {.time = 0.02, .position = {0.01, 0.02, -0.01}}},
          .faults = {fault}};
}

Outcome outcome_of(const InjectedFault& fault) {
  const std::vector<std::string> names = {"a"};
  const auto mailbox =
      std::make_unique<Mailbox>(Capacity{.objects = 1, .fingers = 1, .hips = 1, .contacts = 1, .devices = 1});
  Watched device(held_in_the_wall(fault));
  device.start();
  drivers::Device* const devices[] = {&device};
  ServoLoop loop({.limits = test::wide_limits(), .armed_from_start = true}, devices,
                 prepare_scene(test::wall_scene(names), 1, names), *mailbox);

  Outcome outcome;
  for (std::uint64_t tick = 0; tick < 1000; ++tick) {
    loop.tick({.tick = tick, .time = static_cast<drivers::Nanoseconds>(tick) * 1'000'000});
    const double force = glm::length(device.written.force);
    if (tick == kFailsAt - 1) {
      EXPECT_NEAR(force, 1.0, 0.01);
    }
    if (tick < kFailsAt) continue;
    outcome.largest_after = std::max(outcome.largest_after, force);
    if (force == 0.0 && !outcome.ticks_until_zero) outcome.ticks_until_zero = tick - kFailsAt;
  }
  outcome.fault = loop.fault();
  return outcome;
}

TEST(InjectedFault, ANumberThatIsNoneCutsInItsOwnTick) {
  const Outcome outcome = outcome_of({.kind = InjectedKind::kNotANumber, .at = kFailsAfter});
  EXPECT_EQ(outcome.ticks_until_zero, 0U);
  EXPECT_EQ(outcome.fault.kind, safety::FaultKind::kNotFinite);
  EXPECT_EQ(outcome.fault.tick, kFailsAt);
  EXPECT_EQ(outcome.largest_after, 0.0);
}

// 5 mm in a millisecond are 5 m/s; 2 are allowed. The force of the other depth is never given.
TEST(InjectedFault, AJumpFasterThanIsAllowedCutsInItsOwnTick) {
  const Outcome outcome =
      outcome_of({.kind = InjectedKind::kJump, .at = kFailsAfter, .offset = {0.0, 0.0, -0.005}});
  EXPECT_EQ(outcome.ticks_until_zero, 0U);
  EXPECT_EQ(outcome.fault.kind, safety::FaultKind::kOverSpeed);
  EXPECT_NEAR(outcome.fault.value, 5.0, 0.01);
  EXPECT_EQ(outcome.largest_after, 0.0);
}

// The newest sample is 20 ms old, which is allowed, 19 ticks after the first that is missing.
TEST(InjectedFault, LostSamplesCutWhenTheLastOneIsTooOld) {
  for (const InjectedKind kind : {InjectedKind::kDrop, InjectedKind::kUnplug}) {
    const Outcome outcome = outcome_of({.kind = kind, .at = kFailsAfter});
    EXPECT_EQ(outcome.ticks_until_zero, 20U);
    EXPECT_EQ(outcome.fault.kind, safety::FaultKind::kStaleSample);
    EXPECT_EQ(outcome.fault.device, 0U);
    EXPECT_NEAR(outcome.fault.value, 0.021, 1e-9);
    EXPECT_LT(outcome.largest_after, 1.01);
  }
}

TEST(InjectedFault, AGapWithinTheAllowedAgeIsNoFault) {
  const Outcome outcome = outcome_of({.kind = InjectedKind::kDrop, .at = kFailsAfter, .duration = 0.020});
  EXPECT_EQ(outcome.ticks_until_zero, std::nullopt);
  EXPECT_EQ(outcome.fault.kind, safety::FaultKind::kNone);
}

TEST(InjectedFault, ADelayBeyondTheAllowedAgeCutsInItsFirstTick) {
  const Outcome late = outcome_of({.kind = InjectedKind::kDelay, .at = kFailsAfter, .delay = 0.021});
  EXPECT_EQ(late.ticks_until_zero, 0U);
  EXPECT_EQ(late.fault.kind, safety::FaultKind::kStaleSample);
  const Outcome allowed = outcome_of({.kind = InjectedKind::kDelay, .at = kFailsAfter, .delay = 0.020});
  EXPECT_EQ(allowed.ticks_until_zero, std::nullopt);
  EXPECT_EQ(allowed.fault.kind, safety::FaultKind::kNone);
}

// A pose that stands still in samples that look new is what a hand at rest looks like: nothing tells it
// apart, and the force stays that of the pose, within its limits.
TEST(InjectedFault, AFrozenPoseIsNotFound) {
  const Outcome outcome = outcome_of({.kind = InjectedKind::kFreeze, .at = kFailsAfter});
  EXPECT_EQ(outcome.ticks_until_zero, std::nullopt);
  EXPECT_EQ(outcome.fault.kind, safety::FaultKind::kNone);
  EXPECT_LT(outcome.largest_after, 1.01);
}

}  // namespace
}  // namespace haptic::servo
