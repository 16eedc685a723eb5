#include <gtest/gtest.h>

#include <limits>

#include "tests/support/expect_vector.h"
#include "tests/support/servo_rig.h"

namespace haptic::servo {
namespace {

using test::ServoRig;

constexpr double kRounding = 1e-9;
constexpr glm::dvec3 kNothing{0.0};

class ServoCommands : public ::testing::Test {
 protected:
  /// The only event that has come, which must be an answer.
  EventKind answer(ServoRig& rig) {
    const std::vector<Event> events = rig.events();
    EXPECT_EQ(events.size(), 1u);
    return events.empty() ? EventKind::kTicksMissed : events.front().kind;
  }

  EventKind ask(ServoRig& rig, CommandKind kind) {
    rig.send(kind);
    rig.tick();
    return answer(rig);
  }

  /// 10 mm deep in the wall: 1 N wanted.
  void press(ServoRig& rig) {
    rig.device(0).sample.position = {0.01, 0.02, 0.005};
    rig.tick();
    rig.device(0).sample.position.z = -0.01;
    rig.tick();
  }

  double force(ServoRig& rig) { return rig.device(0).written.force.z; }

  ServoSettings plain_{.limits = test::wide_limits()};
  ServoSettings ramped_ = [] {
    ServoSettings settings{.limits = test::wide_limits()};
    settings.limits.arm_ramp = 0.1;  // 100 ticks
    return settings;
  }();
};

TEST_F(ServoCommands, AnAnswerCarriesTheRequestAndTheTick) {
  ServoRig rig(plain_);
  rig.tick(5);
  rig.send(CommandKind::kPause, 4711);
  rig.tick();
  const std::vector<Event> events = rig.events();
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].kind, EventKind::kDone);
  EXPECT_EQ(events[0].command, CommandKind::kPause);
  EXPECT_EQ(events[0].request, 4711u);
  EXPECT_EQ(events[0].tick, 5u);
}

TEST_F(ServoCommands, NoForceFlowsUntilArmedAndThenItRampsUp) {
  ServoRig rig(ramped_);
  press(rig);
  rig.tick(10);
  EXPECT_EQ(rig.device(0).written.force, kNothing);
  EXPECT_EQ(ask(rig, CommandKind::kArm), EventKind::kDone);  // the first of 100 ticks of the ramp
  EXPECT_NEAR(force(rig), 0.01, kRounding);
  rig.tick(49);
  EXPECT_NEAR(force(rig), 0.5, kRounding);
  rig.tick(50);
  EXPECT_NEAR(force(rig), 1.0, kRounding);
  EXPECT_EQ(ask(rig, CommandKind::kArm), EventKind::kNothingToDo);
  EXPECT_NEAR(force(rig), 1.0, kRounding);
}

TEST_F(ServoCommands, DisarmingBringsForcesDownByTheSlewLimit) {
  ServoSettings settings{.limits = test::wide_limits(), .armed_from_start = true};
  settings.limits.max_force_rate = 250.0;  // 0.25 N in a tick
  ServoRig rig(settings);
  press(rig);
  rig.tick(10);
  ASSERT_NEAR(force(rig), 1.0, kRounding);
  EXPECT_EQ(ask(rig, CommandKind::kDisarm), EventKind::kDone);
  EXPECT_NEAR(force(rig), 0.75, kRounding);
  EXPECT_FALSE(rig.loop().is_at_rest());
  rig.tick(3);
  EXPECT_EQ(rig.device(0).written.force, kNothing);
  EXPECT_TRUE(rig.loop().is_at_rest());
  EXPECT_EQ(ask(rig, CommandKind::kDisarm), EventKind::kNothingToDo);
}

TEST_F(ServoCommands, ArmingIsRefusedWhileAFaultIsLatchedAndWorksOnceItIsCleared) {
  ServoRig rig(plain_);
  EXPECT_EQ(ask(rig, CommandKind::kArm), EventKind::kDone);
  rig.device(0).sample.velocity.x = 100.0;
  rig.tick();
  EXPECT_EQ(answer(rig), EventKind::kFaultLatched);
  rig.device(0).sample.velocity.x = 0.0;
  EXPECT_EQ(ask(rig, CommandKind::kArm), EventKind::kFaultRefused);
  EXPECT_EQ(ask(rig, CommandKind::kClearFault), EventKind::kDone);
  EXPECT_EQ(ask(rig, CommandKind::kClearFault), EventKind::kNothingToDo);
  press(rig);
  EXPECT_EQ(rig.device(0).written.force, kNothing) << "clearing does not arm";
  EXPECT_EQ(ask(rig, CommandKind::kArm), EventKind::kDone);
  EXPECT_NEAR(force(rig), 1.0, kRounding);
}

TEST_F(ServoCommands, AfterALostDeviceTheOthersCanBeArmedAgain) {
  ServoRig rig(plain_);
  EXPECT_EQ(ask(rig, CommandKind::kArm), EventKind::kDone);
  rig.device(1).connected = false;
  rig.tick(30);
  EXPECT_EQ(answer(rig), EventKind::kFaultLatched);
  EXPECT_EQ(ask(rig, CommandKind::kClearFault), EventKind::kDone);
  EXPECT_EQ(ask(rig, CommandKind::kArm), EventKind::kDone);
  press(rig);
  EXPECT_NEAR(force(rig), 1.0, kRounding);
}

TEST_F(ServoCommands, PausingTakesForcesAwayAndStopsTheWorld) {
  ServoRig rig({.limits = test::wide_limits(), .armed_from_start = true});
  press(rig);
  EXPECT_EQ(ask(rig, CommandKind::kPause), EventKind::kDone);
  const std::uint64_t ticks = rig.loop().scene().world.state().ticks;
  EXPECT_EQ(rig.device(0).written.force, kNothing);
  rig.tick(10);
  EXPECT_EQ(rig.loop().scene().world.state().ticks, ticks);
  EXPECT_TRUE(rig.snapshot().paused);
  EXPECT_EQ(ask(rig, CommandKind::kPause), EventKind::kNothingToDo);
}

TEST_F(ServoCommands, ResumingRampsForcesInAgain) {
  ServoSettings settings = ramped_;
  settings.armed_from_start = true;
  ServoRig rig(settings);
  press(rig);
  ASSERT_NEAR(force(rig), 1.0, kRounding);
  ask(rig, CommandKind::kPause);
  EXPECT_EQ(ask(rig, CommandKind::kResume), EventKind::kDone);
  EXPECT_NEAR(force(rig), 0.01, kRounding);
  rig.tick(99);
  EXPECT_NEAR(force(rig), 1.0, kRounding);
  EXPECT_EQ(ask(rig, CommandKind::kResume), EventKind::kNothingToDo);
}

TEST_F(ServoCommands, AStepRunsThatManyTicksOfTheWorldAndIsAnsweredThen) {
  ServoRig rig(plain_);
  ask(rig, CommandKind::kPause);
  const std::uint64_t before = rig.loop().scene().world.state().ticks;
  rig.send(CommandKind::kStep, 9, 5);
  rig.tick(4);
  EXPECT_TRUE(rig.events().empty());
  rig.tick();
  EXPECT_EQ(answer(rig), EventKind::kDone);
  EXPECT_EQ(rig.loop().scene().world.state().ticks, before + 5);
  rig.tick(10);
  EXPECT_EQ(rig.loop().scene().world.state().ticks, before + 5);
}

TEST_F(ServoCommands, AStepOfNoTicksIsOne) {
  ServoRig rig(plain_);
  ask(rig, CommandKind::kPause);
  const std::uint64_t before = rig.loop().scene().world.state().ticks;
  EXPECT_EQ(ask(rig, CommandKind::kStep), EventKind::kDone);
  EXPECT_EQ(rig.loop().scene().world.state().ticks, before + 1);
}

TEST_F(ServoCommands, AStepWhileRunningIsNothingToDo) {
  ServoRig rig(plain_);
  EXPECT_EQ(ask(rig, CommandKind::kStep), EventKind::kNothingToDo);
}

TEST_F(ServoCommands, StepsThatOverlapAllRunAndAreAllAnswered) {
  ServoRig rig(plain_);
  ask(rig, CommandKind::kPause);
  const std::uint64_t before = rig.loop().scene().world.state().ticks;
  rig.send(CommandKind::kStep, 1, 10);
  rig.send(CommandKind::kStep, 2, ~std::uint64_t{0});  // for ever
  rig.tick(20);
  rig.send(CommandKind::kResume, 3);
  rig.tick();
  const std::vector<Event> events = rig.events();
  ASSERT_EQ(events.size(), 3u);
  EXPECT_EQ(events[0].request, 1u);
  EXPECT_EQ(events[1].request, 2u);
  EXPECT_EQ(events[2].request, 3u);
  EXPECT_EQ(rig.loop().scene().world.state().ticks, before + 21);
}

TEST_F(ServoCommands, AResetPutsTheWorldBackToItsFirstTick) {
  ServoRig rig({.limits = test::wide_limits(), .armed_from_start = true});
  press(rig);
  EXPECT_EQ(ask(rig, CommandKind::kReset), EventKind::kDone);
  EXPECT_EQ(rig.loop().scene().world.state().ticks, 1u);
  // the finger is in the solid at tick 0 of the world, which swallows it: no kick outward
  EXPECT_EQ(rig.device(0).written.force, kNothing);
}

TEST_F(ServoCommands, ASwapGivesTheOldSceneBackAndRampsForcesInAgain) {
  ServoSettings settings = ramped_;
  settings.armed_from_start = true;
  ServoRig rig(settings);
  press(rig);
  ASSERT_NEAR(force(rig), 1.0, kRounding);

  rig.device(0).sample.position.z = 0.005;
  const PreparedScene* const old = &rig.loop().scene();
  rig.mailbox().commands.push(
      {.kind = CommandKind::kSwapScene, .request = 5, .scene = rig.prepare(2).release()});
  rig.tick();
  EXPECT_EQ(rig.snapshot().scene_revision, 2u);
  EXPECT_TRUE(rig.snapshot().armed) << "a swap does not disarm";
  const std::vector<Event> events = rig.events();
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(events[0].kind, EventKind::kSceneRetired);
  EXPECT_EQ(events[0].scene, old);
  delete events[0].scene;
  EXPECT_EQ(events[1].kind, EventKind::kDone);
  EXPECT_EQ(events[1].request, 5u);

  // the second tick after the swap presses again
  rig.device(0).sample.position.z = -0.01;
  rig.tick();
  EXPECT_NEAR(force(rig), 0.02, kRounding);
}

TEST_F(ServoCommands, AFaultOutlivesASwap) {
  ServoRig rig({.limits = test::wide_limits(), .armed_from_start = true});
  rig.device(0).sample.velocity.x = 100.0;
  rig.tick();
  rig.mailbox().commands.push({.kind = CommandKind::kSwapScene, .scene = rig.prepare(2).release()});
  rig.tick();
  EXPECT_EQ(rig.loop().fault().kind, safety::FaultKind::kOverSpeed);
  for (const Event& event : rig.events()) delete event.scene;
}

TEST_F(ServoCommands, ALostDriverBringsForceDownByTheSlewLimitAndLatchesAFaultOfThatName) {
  ServoSettings settings{.limits = test::wide_limits(), .armed_from_start = true};
  settings.limits.max_force_rate = 250.0;  // 0.25 N in a tick
  ServoRig rig(settings);
  press(rig);
  rig.tick(10);
  ASSERT_NEAR(force(rig), 1.0, kRounding);
  rig.events();
  rig.mailbox().commands.push(
      {.kind = CommandKind::kLatchFault,
       .fault = {.kind = safety::FaultKind::kLostDriver, .value = 0.12, .limit = 0.1}});
  // 1 N at 0.25 N in a tick: none left after 4 ticks, and no step on the way
  for (const double left : {0.75, 0.5, 0.25, 0.0}) {
    rig.tick();
    EXPECT_NEAR(force(rig), left, kRounding);
  }
  EXPECT_TRUE(rig.loop().is_at_rest());
  const std::vector<Event> events = rig.events();
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(events[0].kind, EventKind::kFaultLatched);
  EXPECT_EQ(events[0].fault.kind, safety::FaultKind::kLostDriver);
  EXPECT_STREQ(safety::name_of(events[0].fault.kind), "lost_driver");
  EXPECT_EQ(events[0].fault.tick, 12u);  // press() ran ticks 0 and 1, and ten followed
  EXPECT_EQ(events[1].kind, EventKind::kDone);

  EXPECT_FALSE(rig.snapshot().armed);
  EXPECT_EQ(ask(rig, CommandKind::kArm), EventKind::kFaultRefused);
  EXPECT_EQ(ask(rig, CommandKind::kClearFault), EventKind::kDone);
  EXPECT_EQ(ask(rig, CommandKind::kArm), EventKind::kDone);
}

TEST_F(ServoCommands, AFaultThatComesWhileForceGoesDownCutsAllDevicesAtOnce) {
  ServoSettings settings{.limits = test::wide_limits(), .armed_from_start = true};
  settings.limits.max_force_rate = 250.0;
  ServoRig rig(settings);
  press(rig);
  rig.tick(10);
  rig.mailbox().commands.push(
      {.kind = CommandKind::kLatchFault, .fault = {.kind = safety::FaultKind::kLostDriver}});
  rig.tick();
  ASSERT_NEAR(force(rig), 0.75, kRounding);
  rig.device(1).sample.velocity.x = std::numeric_limits<double>::quiet_NaN();
  rig.tick();
  EXPECT_EQ(rig.device(0).written.force, kNothing);
  EXPECT_EQ(rig.loop().fault().kind, safety::FaultKind::kLostDriver);
}

TEST_F(ServoCommands, ALostDriverIsNoFaultWhileDisarmed) {
  ServoRig rig(plain_);
  rig.mailbox().commands.push(
      {.kind = CommandKind::kLatchFault, .fault = {.kind = safety::FaultKind::kLostDriver}});
  rig.tick();
  EXPECT_EQ(answer(rig), EventKind::kNothingToDo);
  EXPECT_EQ(rig.loop().fault().kind, safety::FaultKind::kNone);
}

TEST_F(ServoCommands, CommandsWaitWhileThereIsNoRoomForTheirAnswers) {
  ServoRig rig(plain_);
  rig.tick(1100, 1);  // each missed tick is an event; the queue is full now
  const PreparedScene* const old = &rig.loop().scene();
  rig.mailbox().commands.push({.kind = CommandKind::kSwapScene, .scene = rig.prepare(2).release()});
  rig.tick(5);
  EXPECT_EQ(&rig.loop().scene(), old);
  rig.events();
  rig.tick();
  EXPECT_NE(&rig.loop().scene(), old);
  const std::vector<Event> events = rig.events();
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(events[0].scene, old);
  delete events[0].scene;
}

TEST_F(ServoCommands, ATickTakesABoundedNumberOfCommands) {
  ServoRig rig(plain_);
  for (std::uint64_t i = 0; i < 100; ++i) rig.send(CommandKind::kReset, i);
  rig.tick();
  const std::size_t first = rig.events().size();
  EXPECT_GE(first, 1u);
  EXPECT_LE(first, 16u);
  rig.tick(100);
  EXPECT_EQ(first + rig.events().size(), 100u);
}

TEST_F(ServoCommands, ResettingTheStatsForgetsWhatWasCounted) {
  ServoRig rig(plain_);
  rig.tick(150, 1);
  rig.send(CommandKind::kResetStats);
  rig.tick(50);
  ASSERT_TRUE(rig.mailbox().stats.update());
  // the tick that takes the command has woken up before
  EXPECT_EQ(rig.mailbox().stats.latest().wakeup.total(), 49u);
  EXPECT_EQ(rig.mailbox().stats.latest().missed_ticks, 0u);
  EXPECT_EQ(rig.snapshot().missed_ticks, 150u);
}

TEST_F(ServoCommands, ScenesThatAreStillInTheQueuesAreFreedWithTheMailbox) {
  // a leak would be found by AddressSanitizer
  ServoRig rig(plain_);
  rig.mailbox().commands.push({.kind = CommandKind::kSwapScene, .scene = rig.prepare(2).release()});
  rig.tick();
  rig.mailbox().commands.push({.kind = CommandKind::kSwapScene, .scene = rig.prepare(3).release()});
  EXPECT_EQ(rig.loop().scene().revision, 2u);
}

}  // namespace
}  // namespace haptic::servo
