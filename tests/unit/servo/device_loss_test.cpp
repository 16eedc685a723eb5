// What becomes of forces when a driver tells that its device is lost. On a virtual clock; a finger that is
// 10 mm deep in the wall feels 1 N.

#include <gtest/gtest.h>

#include "rt/allocation_guard.h"
#include "tests/support/servo_rig.h"

namespace haptic::servo {
namespace {

using drivers::DevicePhase;
using safety::FaultKind;
using test::ServoRig;

constexpr glm::dvec3 kNothing(0.0);

ServoSettings settings(const std::vector<bool>& stops_alone = {}) {
  ServoSettings settings{.limits = test::wide_limits()};
  for (const bool alone : stops_alone) settings.devices.push_back({.stops_alone = alone});
  return settings;
}

class DeviceLoss : public testing::Test {
 protected:
  /// Both devices press the wall and are pushed by it.
  void press(ServoRig& rig) {
    for (const std::size_t i : {0U, 1U}) {
      rig.device(i).sample.position = {0.0, 0.0, 0.01};
    }
    rig.tick();
    for (const std::size_t i : {0U, 1U}) rig.device(i).sample.position = {0.0, 0.0, -0.01};
    arm(rig);
    rig.tick();
    ASSERT_NEAR(pushed(rig, 0), 1.0, 1e-9);
    ASSERT_NEAR(pushed(rig, 1), 1.0, 1e-9);
  }

  static void arm(ServoRig& rig) {
    rig.events();
    rig.send(CommandKind::kArm);
    rig.tick();
  }
  static EventKind answer_to(ServoRig& rig, CommandKind command) {
    rig.events();
    rig.send(command);
    rig.tick();
    for (const Event& event : rig.events()) {
      if (event.request == 1) return event.kind;
    }
    return EventKind::kTicksMissed;
  }

  static double pushed(ServoRig& rig, std::size_t i) { return rig.device(i).written.force.z; }

  static void lose(ServoRig& rig, std::size_t i) {
    rig.device(i).life = {.phase = DevicePhase::kFound, .losses = rig.device(i).life.losses + 1};
    rig.device(i).connected = false;
  }
  static void come_back(ServoRig& rig, std::size_t i) {
    rig.device(i).life.phase = DevicePhase::kReady;
    rig.device(i).connected = true;
  }

  /// From outside: a finger that appears within the wall is not held by it.
  static void press_again(ServoRig& rig, std::size_t i) {
    rig.device(i).sample.position = {0.0, 0.0, 0.01};
    rig.tick();
    rig.device(i).sample.position = {0.0, 0.0, -0.01};
    rig.tick();
  }

  /// The faults that were told since the last look.
  static std::vector<safety::Fault> faults(ServoRig& rig) {
    std::vector<safety::Fault> all;
    for (const Event& event : rig.events()) {
      if (event.kind == EventKind::kFaultLatched) all.push_back(event.fault);
    }
    return all;
  }
};

TEST_F(DeviceLoss, WhileArmedStopsAllInTheTickInWhichItIsTold) {
  ServoRig rig(settings());
  press(rig);
  rig.events();
  lose(rig, 0);
  rig.tick();
  EXPECT_EQ(rig.device(0).written.force, kNothing);
  EXPECT_EQ(rig.device(1).written.force, kNothing);
  const auto told = faults(rig);
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0].kind, FaultKind::kLostDevice);
  EXPECT_EQ(told[0].device, 0U);
  EXPECT_FALSE(rig.snapshot().armed);
  EXPECT_FALSE(rig.snapshot().devices[0].present) << "its finger is gone with it";
  EXPECT_EQ(rig.snapshot().devices[0].phase, DevicePhase::kFound);
}

TEST_F(DeviceLoss, OfADeviceThatStopsAloneLeavesTheOthersPushing) {
  ServoRig rig(settings({true, true}));
  press(rig);
  rig.events();
  lose(rig, 0);
  for (int i = 0; i < 100; ++i) {
    rig.tick();
    ASSERT_EQ(rig.device(0).written.force, kNothing);
    ASSERT_NEAR(pushed(rig, 1), 1.0, 1e-9);
  }
  const auto told = faults(rig);
  ASSERT_EQ(told.size(), 1U) << "once";
  EXPECT_EQ(told[0].kind, FaultKind::kLostDevice);
  EXPECT_EQ(told[0].device, 0U);
  EXPECT_TRUE(rig.snapshot().armed);
  EXPECT_EQ(rig.snapshot().devices[0].fault.kind, FaultKind::kLostDevice);
  EXPECT_EQ(rig.snapshot().devices[1].fault.kind, FaultKind::kNone);
  EXPECT_FALSE(rig.snapshot().devices[0].armed);
  EXPECT_TRUE(rig.snapshot().devices[1].armed);
}

TEST_F(DeviceLoss, StoppingAloneIsEachDevicesOwnChoice) {
  ServoRig rig(settings({true, false}));
  press(rig);
  lose(rig, 1);
  rig.tick();
  EXPECT_EQ(rig.device(0).written.force, kNothing);
  EXPECT_EQ(rig.device(1).written.force, kNothing);
}

TEST_F(DeviceLoss, ASecondNetCatchesOneThatIsNotTold) {
  for (const bool alone : {false, true}) {
    ServoRig rig(settings({alone, alone}));
    press(rig);
    rig.events();
    rig.device(0).connected = false;
    rig.tick(22);  // max_sample_age is 20 ms
    EXPECT_EQ(rig.device(0).written.force, kNothing);
    EXPECT_NEAR(pushed(rig, 1), alone ? 1.0 : 0.0, 1e-9);
    const auto told = faults(rig);
    ASSERT_EQ(told.size(), 1U);
    EXPECT_EQ(told[0].kind, FaultKind::kStaleSample);
    EXPECT_EQ(told[0].device, 0U);
  }
}

TEST_F(DeviceLoss, AnotherFaultOfOneThatStopsAloneStopsAll) {
  ServoRig rig(settings({true, true}));
  press(rig);
  rig.device(0).sample.velocity = {0.0, 0.0, 3.0};  // beyond max_speed
  rig.tick();
  EXPECT_EQ(rig.device(0).written.force, kNothing);
  EXPECT_EQ(rig.device(1).written.force, kNothing);
}

TEST_F(DeviceLoss, ADeviceThatComesBackGetsNoForceUntilItsFaultIsClearedAndSomebodyArmsAgain) {
  for (const bool alone : {false, true}) {
    ServoRig rig(settings({alone, alone}));
    press(rig);
    lose(rig, 0);
    rig.tick();
    come_back(rig, 0);
    press_again(rig, 0);
    rig.tick(50);
    EXPECT_TRUE(rig.snapshot().devices[0].present);
    EXPECT_EQ(rig.device(0).written.force, kNothing);
    EXPECT_EQ(answer_to(rig, CommandKind::kArm), EventKind::kFaultRefused);
    EXPECT_EQ(answer_to(rig, CommandKind::kClearFault), EventKind::kDone);
    rig.tick(50);
    EXPECT_EQ(rig.device(0).written.force, kNothing) << "clearing is not arming";
    EXPECT_NEAR(pushed(rig, 1), alone ? 1.0 : 0.0, 1e-9) << "and stops nobody";
    EXPECT_EQ(answer_to(rig, CommandKind::kArm), EventKind::kDone);
    rig.tick();
    EXPECT_NEAR(pushed(rig, 0), 1.0, 1e-9);
    EXPECT_NEAR(pushed(rig, 1), 1.0, 1e-9);
  }
}

TEST_F(DeviceLoss, IsSeenEvenIfTheDeviceIsBackInTheNextTick) {
  ServoRig rig(settings());
  press(rig);
  rig.events();
  lose(rig, 0);
  come_back(rig, 0);
  rig.tick();
  EXPECT_EQ(rig.device(0).written.force, kNothing);
  const auto told = faults(rig);
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0].kind, FaultKind::kLostDevice);
}

TEST_F(DeviceLoss, WhileNothingIsArmedIsNoFault) {
  ServoRig rig(settings());
  rig.tick(10);
  lose(rig, 0);
  rig.tick(50);
  EXPECT_TRUE(faults(rig).empty());
  EXPECT_EQ(rig.snapshot().devices[0].phase, DevicePhase::kFound);
  EXPECT_EQ(answer_to(rig, CommandKind::kArm), EventKind::kDone) << "the other one can be used";
  EXPECT_FALSE(rig.snapshot().devices[0].armed);
  EXPECT_TRUE(rig.snapshot().devices[1].armed);
}

TEST_F(DeviceLoss, ADeviceThatComesWhileOthersAreArmedGetsNoForceUntilSomebodyArmsAgain) {
  ServoRig rig(settings());
  lose(rig, 0);
  rig.tick();
  arm(rig);
  EXPECT_EQ(answer_to(rig, CommandKind::kArm), EventKind::kNothingToDo);
  come_back(rig, 0);
  press_again(rig, 0);
  rig.tick(50);
  EXPECT_EQ(rig.device(0).written.force, kNothing);
  lose(rig, 0);
  rig.tick();
  EXPECT_TRUE(faults(rig).empty()) << "it had no force to lose";
  come_back(rig, 0);
  press_again(rig, 0);
  EXPECT_EQ(answer_to(rig, CommandKind::kArm), EventKind::kDone);
  rig.tick();
  EXPECT_NEAR(pushed(rig, 0), 1.0, 1e-9);
}

TEST_F(DeviceLoss, WhatPushesAlreadyKeepsNoLateDeviceFromBeingArmed) {
  ServoSettings limited = settings();
  limited.limits.max_arm_force = 0.5;  // N; device 0 is pushed by 1 N
  ServoRig rig(limited);
  rig.device(1).sample.position = {0.0, 0.0, 0.01};
  lose(rig, 1);
  rig.device(0).sample.position = {0.0, 0.0, 0.01};
  rig.tick();
  rig.device(0).sample.position = {0.0, 0.0, -0.01};
  arm(rig);
  rig.tick();
  ASSERT_NEAR(pushed(rig, 0), 1.0, 1e-9);
  come_back(rig, 1);
  rig.device(1).sample.position = {0.0, 0.0, 0.01};
  rig.tick();
  EXPECT_EQ(answer_to(rig, CommandKind::kArm), EventKind::kDone);
  EXPECT_NEAR(pushed(rig, 0), 1.0, 1e-9);
}

TEST_F(DeviceLoss, ADeviceThatMustBeHomedAgainWhileArmedIsLost) {
  ServoRig rig(settings());
  press(rig);
  rig.device(1).life.phase = DevicePhase::kHoming;
  rig.tick();
  EXPECT_EQ(rig.device(0).written.force, kNothing);
  EXPECT_EQ(rig.snapshot().devices[1].fault.kind, FaultKind::kLostDevice);
}

TEST_F(DeviceLoss, IsFoundWithoutAllocating) {
  ServoRig rig(settings({true, false}));
  press(rig);
  rig.events();
  {
    const rt::AllocationGuard watch;
    lose(rig, 0);
    rig.tick();
    lose(rig, 1);
    rig.tick();
  }
  EXPECT_EQ(rig.device(1).written.force, kNothing);
}

}  // namespace
}  // namespace haptic::servo
