// What a recording needs of a tick: what it followed from, its hash, and a copy of the state to start from.

#include <gtest/gtest.h>

#include <memory>

#include "rt/allocation_guard.h"
#include "tests/support/servo_rig.h"

namespace haptic::servo {
namespace {

using test::ServoRig;

class TickInputsTest : public ::testing::Test {
 protected:
  TickInputsTest() { rig_.device(0).sample.position = {0.01, 0.02, -0.005}; }

  /// Asks for a copy and runs the tick that makes it.
  Event copy(std::uint64_t revision = 1) {
    ask_for_copy(revision);
    rig_.tick();
    for (const Event& event : rig_.events()) {
      if (event.command == CommandKind::kCopyState) {
        copy_.reset(event.copy);
        return event;
      }
    }
    ADD_FAILURE() << "no answer";
    return {};
  }

  void ask_for_copy(std::uint64_t revision = 1) {
    Command command;
    command.kind = CommandKind::kCopyState;
    command.request = 9;
    command.copy = copy_buffer(rig_.loop().scene().world.scene(), revision).release();
    rig_.mailbox().commands.push(command);
  }

  const engine::State& state() { return rig_.loop().scene().world.state(); }

  ServoRig rig_{ServoSettings{.limits = test::wide_limits()}};
  std::unique_ptr<StateCopy> copy_;
};

TEST_F(TickInputsTest, ACopyIsTheStateAfterItsTick) {
  rig_.tick(20);
  const Event answer = copy();
  EXPECT_EQ(answer.kind, EventKind::kDone);
  EXPECT_EQ(answer.request, 9u);
  EXPECT_EQ(answer.tick, 20u);
  ASSERT_TRUE(copy_);
  EXPECT_EQ(engine::hash(copy_->state), engine::hash(state()));
  EXPECT_EQ(copy_->state.ticks, 21u);
  EXPECT_FALSE(copy_->paused);
}

TEST_F(TickInputsTest, ACopyTellsOfThePauseAndTheStepsThatAreLeft) {
  rig_.send(CommandKind::kPause);
  rig_.send(CommandKind::kStep, 1, 5);
  rig_.tick();
  copy();
  ASSERT_TRUE(copy_);
  EXPECT_TRUE(copy_->paused);
  EXPECT_EQ(copy_->steps_left, 3u);
}

TEST_F(TickInputsTest, ACopyForAnotherSceneIsRefusedAndComesBack) {
  const Event answer = copy(7);
  EXPECT_EQ(answer.kind, EventKind::kOutdated);
  EXPECT_TRUE(copy_);
}

TEST_F(TickInputsTest, ASceneThatTakesOverInTheTickOfACopyMakesItOutdated) {
  ask_for_copy();
  Command swap;
  swap.kind = CommandKind::kSwapScene;
  swap.scene = rig_.prepare(2).release();
  rig_.mailbox().commands.push(swap);
  rig_.tick();
  bool refused = false;
  for (const Event& event : rig_.events()) {
    const std::unique_ptr<PreparedScene> retired(event.scene);
    const std::unique_ptr<StateCopy> copy(event.copy);
    refused = refused || (copy != nullptr && event.kind == EventKind::kOutdated);
  }
  EXPECT_TRUE(refused);
}

TEST_F(TickInputsTest, OfTwoCopiesInOneTickTheSecondIsRefused) {
  ask_for_copy();
  ask_for_copy();
  rig_.tick();
  std::vector<EventKind> answers;
  const std::vector<Event> events = rig_.events();
  answers.reserve(events.size());
  for (const Event& event : events) {
    const std::unique_ptr<StateCopy> copy(event.copy);
    answers.push_back(event.kind);
  }
  EXPECT_EQ(answers, (std::vector{EventKind::kOutdated, EventKind::kDone}));
}

TEST_F(TickInputsTest, CopyingAndHashingTakeNoMemory) {
  rig_.tick(10);
  ask_for_copy();
  {
    const rt::AllocationGuard watch;
    rig_.tick();
  }
  for (const Event& event : rig_.events()) copy_.reset(event.copy);
  EXPECT_TRUE(copy_);
}

TEST_F(TickInputsTest, TheHashIsThatOfTheStateAfterTheTick) {
  rig_.tick(3);
  EXPECT_EQ(rig_.snapshot().inputs.state_hash, engine::hash(state()));
  const std::uint64_t before = engine::hash(state());
  rig_.tick();
  EXPECT_NE(rig_.snapshot().inputs.state_hash, before);
}

TEST_F(TickInputsTest, CommandsThatChangeWhatIsSimulatedAreToldInTheirOrder) {
  rig_.send(CommandKind::kArm);  // about force: no input of the world
  rig_.send(CommandKind::kPause);
  rig_.send(CommandKind::kStep, 2, 4);
  rig_.send(CommandKind::kPause);  // is paused already: nothing came of it
  rig_.send(CommandKind::kReset);
  rig_.send(CommandKind::kResume);
  rig_.tick(1, 6);
  const TickInputs inputs = rig_.snapshot().inputs;
  EXPECT_EQ(inputs.missed, 6u);
  ASSERT_EQ(inputs.command_count, 4u);
  EXPECT_EQ(inputs.commands[0].kind, CommandKind::kPause);
  EXPECT_EQ(inputs.commands[1].kind, CommandKind::kStep);
  EXPECT_EQ(inputs.commands[1].ticks, 4u);
  EXPECT_EQ(inputs.commands[2].kind, CommandKind::kReset);
  EXPECT_EQ(inputs.commands[3].kind, CommandKind::kResume);
  rig_.tick();
  EXPECT_EQ(rig_.snapshot().inputs.command_count, 0u);
  EXPECT_EQ(rig_.snapshot().inputs.missed, 0u);
}

TEST_F(TickInputsTest, ASceneThatTakesOverIsToldByItsRevision) {
  Command swap;
  swap.kind = CommandKind::kSwapScene;
  swap.scene = rig_.prepare(5).release();
  rig_.mailbox().commands.push(swap);
  rig_.tick();
  for (const Event& event : rig_.events()) const std::unique_ptr<PreparedScene> retired(event.scene);
  const TickInputs& inputs = rig_.snapshot().inputs;
  ASSERT_EQ(inputs.command_count, 1u);
  EXPECT_EQ(inputs.commands[0].kind, CommandKind::kSwapScene);
  EXPECT_EQ(inputs.commands[0].revision, 5u);
}

}  // namespace
}  // namespace haptic::servo
