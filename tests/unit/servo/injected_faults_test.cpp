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

// held so stiffly, and so heavy, that 1 N does not move it; it creeps by 10 um in a second, as no hand is
// still to the bit
drivers::SimulatedSettings held_in_the_wall(const InjectedFault& fault) {
  return {.name = "a",
          .mass = 1000.0,
          .hand_stiffness = 1e6,
          .hand_damping = 1e6,
          .path = {{.time = 0.0, .position = {0.01, 0.02, 0.005}},
                   {.time = 0.02, .position = {0.01, 0.02, -0.01}},
                   {.time = 1.02, .position = {0.01, 0.02, -0.01001}}},
          .faults = {fault}};
}

Outcome outcome_of(const InjectedFault& fault, const safety::GuardLimits& limits = test::wide_limits()) {
  const std::vector<std::string> names = {"a"};
  const auto mailbox =
      std::make_unique<Mailbox>(Capacity{.objects = 1, .fingers = 1, .hips = 1, .contacts = 1, .devices = 1});
  Watched device(held_in_the_wall(fault));
  device.start();
  drivers::Device* const devices[] = {&device};
  ServoLoop loop({.limits = limits, .armed_from_start = true}, devices,
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
TEST(InjectedFault, AFrozenPoseIsNotFoundByDefault) {
  const Outcome outcome = outcome_of({.kind = InjectedKind::kFreeze, .at = kFailsAfter});
  EXPECT_EQ(outcome.ticks_until_zero, std::nullopt);
  EXPECT_EQ(outcome.fault.kind, safety::FaultKind::kNone);
  EXPECT_LT(outcome.largest_after, 1.01);
}

// Tick 100 brings the pose that stays; 50 ticks later it is 50 ms old, which is allowed.
TEST(InjectedFault, AFrozenPoseCutsWhereStandingStillIsLimited) {
  safety::GuardLimits limits = test::wide_limits();
  limits.max_still = 0.05;
  const Outcome outcome = outcome_of({.kind = InjectedKind::kFreeze, .at = kFailsAfter}, limits);
  EXPECT_EQ(outcome.ticks_until_zero, 51U);
  EXPECT_EQ(outcome.fault.kind, safety::FaultKind::kStillSample);
  EXPECT_NEAR(outcome.fault.value, 0.051, 1e-9);
  const Outcome moving = outcome_of({.kind = InjectedKind::kFreeze, .at = 10.0}, limits);
  EXPECT_EQ(moving.fault.kind, safety::FaultKind::kNone) << "a hand that creeps moves";
}

// 1.5 mm in a millisecond are no over-speed, but beyond the side of the box.
TEST(InjectedFault, AJumpBeyondTheTravelCutsInItsOwnTick) {
  safety::GuardLimits limits = test::wide_limits();
  limits.travel = {{-1.0, -1.0, -0.0105}, {1.0, 1.0, 1.0}};
  const Outcome outcome =
      outcome_of({.kind = InjectedKind::kJump, .at = kFailsAfter, .offset = {0.0, 0.0, -0.0015}}, limits);
  EXPECT_EQ(outcome.ticks_until_zero, 0U);
  EXPECT_EQ(outcome.fault.kind, safety::FaultKind::kOverTravel);
  EXPECT_NEAR(outcome.fault.value, -0.0115, 1e-4);
  EXPECT_EQ(outcome.fault.limit, -0.0105);
  EXPECT_EQ(outcome.largest_after, 0.0);
}

// A wall of K = 2000 N/m gives no energy to a hand with a damping above K (T / 2 + delay) (Colgate): 1 N s/m
// at 1 kHz, and 21 N s/m when it hears of the device 10 ms late. The hand here has 3, and begins to shake. In
// a tick below the limits no more is given than 5 N * 2 m/s * 1 ms = 10 mJ, so that much the bound is
// exceeded at the most; and 20 mJ are 0.63 m/s of the mass of 0.1 kg: it is not the limit of speed that finds
// it.
TEST(InjectedFault, AWallThatIsTooStiffForItsDelayIsCutByTheEnergyItGives) {
  const std::vector<std::string> names = {"a"};
  const auto mailbox =
      std::make_unique<Mailbox>(Capacity{.objects = 1, .fingers = 1, .hips = 1, .contacts = 1, .devices = 1});
  const auto run = [&](double delay, safety::FaultKind& latched, double& value) {
    Watched device({.name = "a",
                    .mass = 0.1,
                    .hand_stiffness = 100.0,
                    .hand_damping = 3.0,
                    .path = {{.time = 0.0, .position = {0.01, 0.02, 0.005}},
                             {.time = 0.05, .position = {0.01, 0.02, -0.01}}},
                    .faults = {{.kind = InjectedKind::kDelay, .at = 0.0, .delay = delay}}});
    device.start();
    drivers::Device* const devices[] = {&device};
    const auto scene = test::wall_scene(names);
    scene->fingers[0].stiffness = 2000.0;
    safety::GuardLimits limits = test::wide_limits();
    limits.max_force = 5.0;
    limits.max_energy = 0.02;
    ServoLoop loop({.limits = limits, .armed_from_start = true}, devices, prepare_scene(scene, 1, names),
                   *mailbox);
    for (std::uint64_t tick = 0; tick < 2000; ++tick) {
      loop.tick({.tick = tick, .time = static_cast<drivers::Nanoseconds>(tick) * 1'000'000});
      if (loop.fault().kind == safety::FaultKind::kNone) continue;
      EXPECT_EQ(loop.fault().tick, tick);
      EXPECT_EQ(device.written.force, glm::dvec3(0.0)) << "in the tick that finds it";
      break;
    }
    latched = loop.fault().kind;
    value = loop.fault().value;
  };
  safety::FaultKind latched{};
  double value = 0.0;
  run(0.010, latched, value);
  EXPECT_EQ(latched, safety::FaultKind::kEnergy);
  EXPECT_GT(value, 0.02);
  EXPECT_LT(value, 0.03);
  run(1e-6, latched, value);
  EXPECT_EQ(latched, safety::FaultKind::kNone) << "without the delay the same hand rests on the same wall";
}

}  // namespace
}  // namespace haptic::servo
