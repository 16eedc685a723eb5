// What was recorded of one servo loop gives, in another, the same bits after every tick.

#include "replay/replayer.h"

#include <gtest/gtest.h>

#include <bit>

#include "load/error.h"
#include "tests/support/recording_rig.h"

namespace haptic::replay {
namespace {

using servo::CommandKind;
using test::Item;
using test::RecordingRig;
using test::replay_all;

/// Every tick after the first state was run again and is the same.
void expect_exact(const RecordingRig& rig, std::uint64_t ticks) {
  const Report report = replay_all(rig.items());
  EXPECT_FALSE(report.difference) << report.difference->tick << " " << report.difference->where;
  EXPECT_EQ(report.ticks, ticks);
  EXPECT_EQ(report.compared, ticks);
  EXPECT_EQ(report.unreachable, 0u);
  EXPECT_TRUE(report.gaps.empty());
}

v1::Frame& frame_of(RecordingRig& rig, std::uint64_t tick) {
  for (Item& item : rig.items()) {
    auto* const frame = std::get_if<v1::Frame>(&item);
    if (frame != nullptr && frame->tick() == tick) return *frame;
  }
  throw std::out_of_range("no such tick");
}

TEST(Replayer, GivesTheSameStatesFromTheStart) {
  RecordingRig rig;
  rig.tick_and_copy();
  rig.tick(800);
  expect_exact(rig, 800);
}

TEST(Replayer, TheBoxIsHeldAndMovesSoThatThereIsSomethingToGetWrong) {
  RecordingRig rig;
  rig.tick(800);
  const engine::State& state = rig.world().state();
  const auto holding =
      std::count_if(state.proxies.begin(), state.proxies.end(),
                    [](const engine::Proxy& proxy) { return proxy.state == engine::ConstraintState::kSur; });
  EXPECT_GT(holding, 4);
  EXPECT_GT(state.bodies[0].world_from_object.position.y, 0.001);
}

TEST(Replayer, GivesTheSameStatesFromTheMiddle) {
  RecordingRig rig;
  rig.tick(500);
  rig.tick_and_copy();
  rig.tick(300);
  expect_exact(rig, 300);
}

TEST(Replayer, GoesThroughAReset) {
  RecordingRig rig;
  rig.tick(400);
  rig.tick_and_copy();
  rig.tick(50);
  rig.send(CommandKind::kReset);
  rig.tick(300);
  expect_exact(rig, 350);
}

TEST(Replayer, StandsStillWhilePausedAndStepsAsItWasStepped) {
  RecordingRig rig;
  rig.tick(400);
  rig.tick_and_copy();
  rig.send(CommandKind::kPause);
  rig.tick(20);
  rig.send(CommandKind::kStep, 3);
  rig.tick(20);
  rig.send(CommandKind::kResume);
  rig.tick(100);
  expect_exact(rig, 140);
}

TEST(Replayer, StartsWhilePausedWithStepsLeft) {
  RecordingRig rig;
  rig.tick(400);
  rig.send(CommandKind::kPause);
  rig.send(CommandKind::kStep, 10);
  rig.tick(3);
  rig.tick_and_copy();
  const std::uint64_t ticks = rig.world().state().ticks;
  rig.tick(30);
  EXPECT_EQ(rig.world().state().ticks, ticks + 6);
  rig.send(CommandKind::kResume);
  rig.tick(50);
  expect_exact(rig, 80);
}

TEST(Replayer, GoesThroughEditsAndTakesOverWhatTheyLeaveAlone) {
  RecordingRig rig;
  rig.tick(400);
  rig.tick_and_copy();
  rig.tick(20);
  // what is held goes on, and another box is felt at once
  rig.edit(R"(edit { add_object { name: "second" shape { box { size { x: 0.02 y: 0.02 z: 0.02 } } }
                       inside: "wood" pose { position { x: 0.09 y: 0.01 } } dynamic { linear_viscosity: 0.8 } } }
              edit { set_gravity { y: -0.5 } })");
  rig.tick(100);
  rig.edit(R"(edit { move_object { name: "box" pose { position { x: 0.03 y: 0.02 } } } })");
  rig.tick(100);
  rig.edit(R"(edit { remove_finger: "thumb" })");
  rig.tick(100);
  expect_exact(rig, 320);
}

TEST(Replayer, StartsInTheMiddleOfASceneThatWasEdited) {
  RecordingRig rig;
  rig.tick(400);
  rig.edit(R"(edit { set_gravity { y: -0.5 } })");
  rig.tick(10);
  rig.tick_and_copy();
  rig.tick(100);
  rig.send(CommandKind::kReset);
  rig.tick(100);
  expect_exact(rig, 200);
}

TEST(Replayer, GoesThroughALoad) {
  RecordingRig rig;
  rig.tick(300);
  rig.tick_and_copy();
  v1::Scene other = test::grasp_scene();
  other.mutable_object(0)->mutable_shape()->mutable_box()->mutable_size()->set_x(0.06);
  rig.tick(10);
  rig.load_scene(other);
  rig.tick(200);
  expect_exact(rig, 210);
}

TEST(Replayer, ObeysTheCommandsOfOneTickInTheirOrder) {
  RecordingRig rig;
  rig.tick(400);
  rig.tick_and_copy();
  rig.edit(R"(edit { set_gravity { y: -0.5 } })");
  rig.send(CommandKind::kPause);
  rig.send(CommandKind::kStep, 2);
  rig.send(CommandKind::kReset);
  rig.send(CommandKind::kStep, 3);
  rig.tick(20);
  expect_exact(rig, 20);
}

TEST(Replayer, MissedTicksAreNoGap) {
  RecordingRig rig;
  rig.tick(400);
  rig.tick_and_copy();
  rig.tick(10);
  rig.tick(1, 7);
  rig.tick(100);
  expect_exact(rig, 111);
}

TEST(Replayer, ADeviceMayBeGoneAndComeBack) {
  RecordingRig rig;
  rig.tick(400);
  rig.tick_and_copy();
  rig.left().connected = false;
  rig.tick(60);  // after 20 ms its last sample is too old
  EXPECT_EQ(rig.world().state().finger_started[0], 0);
  rig.left().connected = true;
  rig.tick(60);
  EXPECT_EQ(rig.world().state().finger_started[0], 1);
  expect_exact(rig, 120);
}

TEST(Replayer, APoseThatIsNoNumberIsReplayedToo) {
  RecordingRig rig;
  rig.tick(400);
  rig.tick_and_copy();
  rig.left().sample.orientation.w = std::numeric_limits<double>::quiet_NaN();
  rig.tick(5);
  rig.left().sample.orientation.w = 1.0;
  rig.tick(60);
  expect_exact(rig, 65);
}

TEST(Replayer, ASingleBitOfASampleThatDiffersIsNamedAtItsTick) {
  RecordingRig rig;
  rig.tick(400);
  rig.tick_and_copy();
  rig.tick(100);
  double& x = *frame_of(rig, 450).mutable_inputs()->mutable_position()->Mutable(0);
  x = std::bit_cast<double>(std::bit_cast<std::uint64_t>(x) ^ 1U);
  const Report report = replay_all(rig.items());
  ASSERT_TRUE(report.difference);
  EXPECT_EQ(report.difference->tick, 450u);
  EXPECT_EQ(report.difference->where.rfind("HIP 0 of finger thumb: position.x is ", 0), 0u)
      << report.difference->where;
  EXPECT_NE(report.difference->recorded, report.difference->replayed);
  EXPECT_EQ(report.ticks, 50u);
}

TEST(Replayer, ACommandThatIsLeftAwayIsNamedAtItsTick) {
  RecordingRig rig;
  rig.tick(400);
  rig.tick_and_copy();
  rig.tick(10);
  rig.send(CommandKind::kReset);
  rig.tick(10);
  frame_of(rig, 411).mutable_inputs()->clear_command();
  const Report report = replay_all(rig.items());
  ASSERT_TRUE(report.difference);
  EXPECT_EQ(report.difference->tick, 411u);
}

TEST(Replayer, BeyondLostTicksItGoesOnFromTheNextState) {
  RecordingRig rig;
  rig.tick_and_copy();  // tick 0
  rig.tick(100);        // 1 to 100
  rig.tick_and_copy();  // 101
  rig.tick(50);         // 102 to 151
  std::erase_if(rig.items(), [](const Item& item) {
    const auto* const frame = std::get_if<v1::Frame>(&item);
    return frame != nullptr && frame->tick() >= 50 && frame->tick() < 60;
  });
  const Report report = replay_all(rig.items());
  EXPECT_FALSE(report.difference);
  ASSERT_EQ(report.gaps.size(), 1u);
  EXPECT_EQ(report.gaps[0].first_tick, 50u);
  EXPECT_EQ(report.gaps[0].last_tick, 59u);
  EXPECT_EQ(report.unreachable, 42u);  // 60 to 101
  EXPECT_EQ(report.ticks, 49u + 50u);
  EXPECT_EQ(report.starts, 2u);
}

TEST(Replayer, AStateOnTheWayIsComparedToo) {
  RecordingRig rig;
  rig.tick_and_copy();
  rig.tick(9);
  rig.tick_and_copy();
  rig.tick(10);
  EXPECT_FALSE(replay_all(rig.items()).difference);
  for (Item& item : rig.items()) {
    auto* const state = std::get_if<v1::WorldState>(&item);
    if (state != nullptr && state->tick() == 10) state->set_state_hash(4711);
  }
  const Report report = replay_all(rig.items());
  ASSERT_TRUE(report.difference);
  EXPECT_EQ(report.difference->tick, 10u);
}

TEST(Replayer, FramesBeforeTheFirstStateAreNotReplayed) {
  RecordingRig rig;
  rig.tick(10);
  EXPECT_EQ(replay_all(rig.items()).ticks, 0u);
}

TEST(Replayer, RefusesAStateThatIsNotOfItsScene) {
  RecordingRig rig;
  rig.tick(300);
  rig.tick_and_copy();
  Replayer replayer;
  v1::WorldState state = std::get<v1::WorldState>(rig.items().back());
  EXPECT_THROW(replayer.take(state), load::LoadError);  // no scene
  replayer.add_scene(std::get<v1::SceneDescription>(rig.items().front()));
  const auto refused = [&](const char* field, const std::function<void(v1::WorldState&)>& spoil) {
    v1::WorldState spoilt = state;
    spoil(spoilt);
    try {
      replayer.take(spoilt);
      ADD_FAILURE() << field << " was accepted";
    } catch (const load::LoadError& error) {
      EXPECT_EQ(error.field(), field);
    }
  };
  refused("state.position", [](v1::WorldState& s) { s.add_position(0.0); });
  refused("state.proxy_cell[2]", [](v1::WorldState& s) { s.set_proxy_cell(2, 1'000'000); });
  refused("state.proxy_state[1]",
          [](v1::WorldState& s) { s.set_proxy_state(1, static_cast<v1::ConstraintState>(17)); });
  refused("state.velocity[1]",
          [](v1::WorldState& s) { s.set_velocity(1, std::numeric_limits<double>::infinity()); });
  refused("state.rate_hz", [](v1::WorldState& s) { s.set_rate_hz(0.0); });
  refused("state.state_hash", [](v1::WorldState& s) { s.set_velocity(0, 1.0); });
  EXPECT_NO_THROW(replayer.take(state));
}

TEST(Replayer, RefusesInputsThatDoNotFit) {
  RecordingRig rig;
  rig.tick_and_copy();
  rig.tick();
  const auto refused = [&](const char* field, const std::function<void(v1::InputsFrame&)>& spoil) {
    std::vector<Item> items = rig.items();
    spoil(*std::get<v1::Frame>(items.back()).mutable_inputs());
    try {
      replay_all(items);
      ADD_FAILURE() << field << " was accepted";
    } catch (const load::LoadError& error) {
      EXPECT_EQ(error.field(), field);
    }
  };
  refused("inputs.orientation", [](v1::InputsFrame& inputs) { inputs.clear_orientation(); });
  refused("inputs.command", [](v1::InputsFrame& inputs) { inputs.add_command(); });
  refused("scene_revision", [](v1::InputsFrame& inputs) {
    v1::InputsFrame::Command& command = *inputs.add_command();
    command.set_kind(v1::InputsFrame::SCENE);
    command.set_scene_revision(99);
  });
}

}  // namespace
}  // namespace haptic::replay
