// What is set for one device alone, in the tick: its limits, workspace, filter and buttons; and who may arm.

#include <gtest/gtest.h>

#include <cmath>

#include "rt/allocation_guard.h"
#include "tests/support/expect_vector.h"
#include "tests/support/servo_rig.h"

namespace haptic::servo {
namespace {

using test::ServoRig;

constexpr double kRounding = 1e-9;
constexpr glm::dvec3 kNothing{0.0};

ServoSettings armed(const DeviceSettings& first) {
  return {.limits = test::wide_limits(), .devices = {first}, .armed_from_start = true};
}

/// Both devices start in air, and the first then presses 10 mm into the wall: 1 N.
void press(ServoRig& rig) {
  rig.device(0).sample.position = {0.01, 0.02, 0.005};
  rig.tick();
  rig.device(0).sample.position.z = -0.01;
  rig.tick();
}

double force(ServoRig& rig, std::size_t device = 0) { return rig.device(device).written.force.z; }

TEST(DeviceSettings, TheLimitsOfOneDeviceAreItsOwn) {
  ServoRig rig(armed({.limits = {.max_force = 0.25}}));
  rig.device(1).sample.position = {0.01, 0.02, 0.005};
  press(rig);
  rig.device(1).sample.position.z = -0.01;
  rig.tick();
  EXPECT_NEAR(force(rig), 0.25, kRounding);
  EXPECT_NEAR(force(rig, 1), 1.0, kRounding);
  EXPECT_EQ(rig.snapshot().devices[0].limits, safety::kLimitForce);
  EXPECT_EQ(rig.snapshot().devices[1].limits, safety::kLimitNone);
}

// The travel is told in the frame of the base, whose z is up by half a metre and turned over.
TEST(DeviceSettings, TravelIsOfTheDevicesOwnFrame) {
  DeviceSettings settings;
  settings.workspace.world_from_base = {{0.0, 0.0, 0.5}, {0.0, 1.0, 0.0, 0.0}};
  settings.limits.travel = {{-1.0, -1.0, 0.0}, {1.0, 1.0, 0.505}};
  ServoRig rig(armed(settings));
  rig.device(0).sample.position = {0.01, 0.02, 0.005};  // 0.495 there
  rig.tick();
  EXPECT_EQ(rig.loop().fault().kind, safety::FaultKind::kNone);
  rig.device(0).sample.position.z = -0.01;  // 0.51
  rig.tick();
  EXPECT_EQ(rig.loop().fault().kind, safety::FaultKind::kOverTravel);
  EXPECT_NEAR(rig.loop().fault().value, 0.51, kRounding);
  EXPECT_EQ(rig.loop().fault().limit, 0.505);
  EXPECT_EQ(rig.device(0).written.force, kNothing);
}

// Scaled by 2 about the world's origin the hand is 10 mm deep where it is at -5 mm; of the 1 N in the world
// it feels a tenth, and limits are of what it feels.
TEST(DeviceSettings, AWorkspaceScalesMotionAndForce) {
  DeviceSettings settings;
  settings.workspace.scale = 2.0;
  settings.workspace.force_scale = 0.1;
  ServoRig rig(armed(settings));
  rig.device(0).sample.position = {0.01, 0.02, 0.005};
  rig.tick();
  rig.device(0).sample.position.z = -0.005;
  rig.device(0).sample.velocity = {0.0, 0.0, -0.1};
  rig.tick();
  EXPECT_NEAR(force(rig), 0.1, kRounding);
  const Snapshot& snapshot = rig.snapshot();
  EXPECT_TRUE(test::near(snapshot.hips[0].position, {0.02, 0.04, -0.01}, kRounding));
  EXPECT_TRUE(test::near(snapshot.objects[0].force, {0.0, 0.0, -1.0}, kRounding));
  // what is told is what the tick used: with these a replay comes to the same state
  EXPECT_TRUE(test::near(snapshot.devices[0].position, {0.02, 0.04, -0.01}, kRounding));
  EXPECT_TRUE(test::near(snapshot.devices[0].velocity, {0.0, 0.0, -0.2}, kRounding));
}

TEST(DeviceSettings, SpeedIsThatOfTheHand) {
  DeviceSettings settings;
  settings.workspace.scale = 100.0;
  ServoRig rig(armed(settings));
  rig.device(0).sample.velocity.x = 1.9;  // 190 m/s in the world
  rig.tick();
  EXPECT_EQ(rig.loop().fault().kind, safety::FaultKind::kNone);
  rig.device(0).sample.velocity.x = 2.1;
  rig.tick();
  EXPECT_EQ(rig.loop().fault().kind, safety::FaultKind::kOverSpeed);
}

TEST(DeviceSettings, TheClutchHoldsTheHipsAndTakesTheForceAway) {
  DeviceSettings settings;
  settings.workspace.clutch_button = 2;
  ServoSettings servo = armed(settings);
  servo.limits.max_force_rate = 250.0;  // 0.25 N in a tick
  servo.limits.arm_ramp = 0.1;          // 100 ticks
  ServoRig rig(servo);
  press(rig);
  rig.tick(10);
  ASSERT_NEAR(force(rig), 1.0, kRounding);

  rig.device(0).sample.buttons = 1U << 2U;
  for (const double left : {0.75, 0.5, 0.25, 0.0, 0.0}) {
    rig.tick();
    EXPECT_NEAR(force(rig), left, kRounding);
    rig.device(0).sample.position += glm::dvec3(0.01);  // out of the wall
  }
  const Snapshot held = rig.snapshot();
  EXPECT_TRUE(test::near(held.hips[0].position, {0.01, 0.02, -0.01}, kRounding));
  EXPECT_TRUE(test::near(held.hips[0].force, {0.0, 0.0, 1.0}, kRounding)) << "the world goes on";
  EXPECT_TRUE(held.devices[0].clutched);
  EXPECT_NE(held.devices[0].limits & safety::kLimitClutch, 0U);
  EXPECT_TRUE(held.armed);

  rig.device(0).sample.buttons = 0;
  for (int tick = 1; tick <= 100; ++tick) {
    rig.tick();
    ASSERT_NEAR(force(rig), tick / 100.0, kRounding);
  }
  EXPECT_TRUE(test::near(rig.snapshot().hips[0].position, {0.01, 0.02, -0.01}, kRounding));
  rig.device(0).sample.position.z += 0.005;  // on from there
  rig.tick();
  EXPECT_TRUE(test::near(rig.snapshot().hips[0].position, {0.01, 0.02, -0.005}, kRounding));
}

TEST(DeviceSettings, AFilterTellsTheVelocityOfADeviceThatTellsNone) {
  DeviceSettings settings;
  settings.filter.kind = MotionFilterKind::kAdaptiveWindow;
  ServoRig rig(armed(settings));
  for (int i = 0; i < 30; ++i) {
    rig.device(0).sample.position.x = 0.0005 * i;
    rig.tick();
  }
  EXPECT_NEAR(rig.snapshot().devices[0].velocity.x, 0.5, kRounding);
  rig.device(0).sample.position.x += 0.003;  // 3 m/s
  rig.tick();
  EXPECT_EQ(rig.loop().fault().kind, safety::FaultKind::kOverSpeed);
}

TEST(StopButton, CutsInItsOwnTickAndLatchesAFaultOfTheDaemon) {
  ServoRig rig(armed({.stop_button = 1}));
  press(rig);
  ASSERT_NEAR(force(rig), 1.0, kRounding);
  rig.events();
  rig.device(0).sample.buttons = 1U << 1U;
  rig.tick();
  EXPECT_EQ(rig.device(0).written.force, kNothing);
  EXPECT_EQ(rig.loop().fault().kind, safety::FaultKind::kEmergencyStop);
  EXPECT_EQ(rig.loop().fault().device, safety::kNoDevice);
  EXPECT_EQ(rig.loop().fault().tick, 2U);
  ASSERT_EQ(rig.events().size(), 1U);
  EXPECT_FALSE(rig.snapshot().armed);
}

TEST(StopButton, StopsTheOtherDevicesToo) {
  ServoSettings settings{
      .limits = test::wide_limits(), .devices = {{}, {.stop_button = 0}}, .armed_from_start = true};
  ServoRig rig(settings);
  press(rig);
  rig.device(1).sample.buttons = 1;
  rig.tick();
  EXPECT_EQ(rig.device(0).written.force, kNothing);
}

TEST(StopButton, WorksBeforeArmingAndWhileItIsDownNothingClearsIt) {
  ServoSettings settings{.limits = test::wide_limits(), .devices = {{.stop_button = 1}}};
  ServoRig rig(settings);
  rig.device(0).sample.buttons = 2;
  rig.tick();
  EXPECT_EQ(rig.loop().fault().kind, safety::FaultKind::kEmergencyStop);
  rig.send(CommandKind::kClearFault);
  rig.tick();
  rig.send(CommandKind::kArm);
  rig.tick();
  EXPECT_FALSE(rig.snapshot().armed);
  rig.device(0).sample.buttons = 0;
  rig.send(CommandKind::kClearFault);
  rig.tick();
  rig.send(CommandKind::kArm);
  rig.tick();
  EXPECT_TRUE(rig.snapshot().armed);
}

TEST(StopButton, IsNoOtherButton) {
  ServoRig rig(armed({.stop_button = 1}));
  rig.device(0).sample.buttons = ~2U;
  rig.device(1).sample.buttons = ~0U;
  rig.tick(3);
  EXPECT_EQ(rig.loop().fault().kind, safety::FaultKind::kNone);
}

TEST(EmergencyStop, CutsInTheTickThatSeesIt) {
  ServoRig rig(armed({}));
  press(rig);
  rig.events();
  rig.mailbox().emergency_stop = true;
  rig.tick();
  EXPECT_EQ(rig.device(0).written.force, kNothing);
  EXPECT_EQ(rig.loop().fault().kind, safety::FaultKind::kEmergencyStop);
  EXPECT_FALSE(rig.mailbox().emergency_stop);
  const std::vector<Event> events = rig.events();
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events[0].kind, EventKind::kFaultLatched);
}

TEST(EmergencyStop, WaitsForNoOtherCommand) {
  ServoRig rig(armed({}));
  press(rig);
  for (std::uint64_t i = 0; i < 200; ++i) rig.send(CommandKind::kResetStats, i);  // 25 ticks of them
  rig.mailbox().emergency_stop = true;
  rig.tick();
  EXPECT_EQ(rig.device(0).written.force, kNothing);
  // nor for room for events
  ServoRig full(armed({}));
  press(full);
  full.tick(1100, 1);
  full.mailbox().emergency_stop = true;
  full.tick();
  EXPECT_EQ(full.device(0).written.force, kNothing);
}

TEST(EmergencyStop, IsAnsweredAsACommand) {
  ServoRig rig(armed({}));
  press(rig);
  rig.events();
  rig.send(CommandKind::kEmergencyStop, 77);
  rig.tick();
  EXPECT_EQ(rig.device(0).written.force, kNothing);
  const std::vector<Event> events = rig.events();
  ASSERT_EQ(events.size(), 2U);
  EXPECT_EQ(events[0].kind, EventKind::kFaultLatched);
  EXPECT_EQ(events[1].kind, EventKind::kDone);
  EXPECT_EQ(events[1].request, 77U);
}

TEST(EmergencyStop, CutsAForceThatGoesDownBecauseOfALostDriver) {
  ServoSettings settings = armed({});
  settings.limits.max_force_rate = 250.0;
  ServoRig rig(settings);
  press(rig);
  rig.tick(10);
  rig.mailbox().commands.push(
      {.kind = CommandKind::kLatchFault, .fault = {.kind = safety::FaultKind::kLostDriver}});
  rig.tick();
  ASSERT_GT(force(rig), 0.5);
  rig.mailbox().emergency_stop = true;
  rig.tick();
  EXPECT_EQ(rig.device(0).written.force, kNothing);
}

class Arming : public ::testing::Test {
 protected:
  Event arm(ServoRig& rig) {
    rig.events();
    rig.send(CommandKind::kArm);
    rig.tick();
    return rig.events().back();
  }

  ServoSettings settings_ = [] {
    ServoSettings settings{.limits = test::wide_limits()};
    settings.limits.max_arm_force = 0.5;
    return settings;
  }();
};

TEST_F(Arming, IsRefusedWhileMoreForceWaitsThanMay) {
  ServoRig rig(settings_, {"a", "b"});
  rig.device(1).sample.position = {0.01, 0.02, 0.005};
  rig.tick();
  rig.device(1).sample.position.z = -0.00501;  // 0.501 N
  rig.tick();
  const Event refused = arm(rig);
  EXPECT_EQ(refused.kind, EventKind::kForceWaits);
  EXPECT_EQ(refused.waiting.device, 1U);
  EXPECT_NEAR(refused.waiting.force, 0.501, kRounding);
  EXPECT_EQ(refused.waiting.limit, 0.5);
  EXPECT_FALSE(rig.snapshot().armed);
  rig.device(1).sample.position.z = -0.00499;
  rig.tick();
  EXPECT_EQ(arm(rig).kind, EventKind::kDone);
  EXPECT_TRUE(rig.snapshot().armed);
}

TEST_F(Arming, ForceThatWaitsIsThatOnTheHand) {
  DeviceSettings weak;
  weak.workspace.force_scale = 0.4;
  settings_.devices = {weak};
  ServoRig rig(settings_);
  press(rig);  // 1 N in the world, 0.4 N on the hand
  EXPECT_EQ(arm(rig).kind, EventKind::kDone);
}

TEST_F(Arming, APauseHidesNoForce) {
  ServoRig rig(settings_);
  press(rig);
  rig.send(CommandKind::kPause);
  rig.tick();
  EXPECT_EQ(arm(rig).kind, EventKind::kForceWaits);
}

TEST(DeviceSettings, AllOfItIsRealTimeSafe) {
  DeviceSettings settings;
  settings.limits = {
      .max_mean_force = 0.2, .max_energy = 0.5, .travel = {{-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0}}};
  settings.workspace = {.scale = 1.5, .force_scale = 0.5, .clutch_button = 2};
  settings.filter.kind = MotionFilterKind::kAdaptiveWindow;
  settings.stop_button = 1;
  ServoSettings servo = armed(settings);
  servo.limits.max_still = 10.0;
  ServoRig rig(servo);
  const rt::AllocationGuard watch;
  for (int i = 0; i < 1000; ++i) {
    rig.device(0).sample.position = {0.01 * std::sin(i * 0.01), 0.02, -0.01 * std::sin(i * 0.02)};
    rig.device(0).sample.buttons = i % 100 > 90 ? 4U : 0U;
    rig.tick();
  }
  EXPECT_EQ(rig.loop().fault().kind, safety::FaultKind::kNone);
  rig.device(0).sample.buttons = 2;
  rig.tick();
  rig.mailbox().emergency_stop = true;
  rig.tick();
}

}  // namespace
}  // namespace haptic::servo
