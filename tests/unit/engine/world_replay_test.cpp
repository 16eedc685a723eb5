// A step is a function of scene, state, fingers and dt alone: what was run once can be run again.

#include <gtest/gtest.h>

#include "engine/world.h"
#include "tests/support/allocation_count.h"
#include "tests/support/small_world.h"

namespace haptic::engine {
namespace {

using test::cube;
using test::finger_of;
using test::rigid;
using test::run;
using test::two_fingers_two_objects;
using test::world_of;

TEST(World, RepeatsItselfToTheBit) {
  World a = two_fingers_two_objects();
  World b = two_fingers_two_objects();
  run(a, 0, 1000);
  run(b, 0, 1000);
  EXPECT_EQ(hash(a.state()), hash(b.state()));
  EXPECT_NE(hash(a.state()), hash(two_fingers_two_objects().state()));
  EXPECT_EQ(a.transitions().count, b.transitions().count);
}

TEST(World, GivesTheSameBitsOnEveryCompilerAndProcessor) {
  // not derived: what the first build gave. It changes whenever the engine's arithmetic does; if nothing was
  // meant to change it, something is not deterministic.
  World world = two_fingers_two_objects();
  run(world, 0, 2000);
  EXPECT_EQ(hash(world.state()), 10553760842369053587U);
}

TEST(World, GoesOnFromACopyOfItsState) {
  World a = two_fingers_two_objects();
  run(a, 0, 500);
  const State copy = a.state();
  run(a, 500, 1000);
  World b = two_fingers_two_objects();
  ASSERT_TRUE(b.restore(copy));
  run(b, 500, 1000);
  EXPECT_EQ(hash(a.state()), hash(b.state()));
}

TEST(World, RefusesTheStateOfAnotherScene) {
  World a = two_fingers_two_objects();
  const std::uint64_t before = hash(a.state());
  EXPECT_FALSE(a.restore(State{}));
  const World other = world_of({cube(rigid(), true)}, {finger_of(point_layout())});
  EXPECT_FALSE(a.restore(other.state()));
  EXPECT_EQ(hash(a.state()), before);
}

TEST(World, ResetsToTheStart) {
  World world = two_fingers_two_objects();
  const std::uint64_t start = hash(world.state());
  run(world, 0, 600);
  const std::uint64_t once = hash(world.state());
  world.reset();
  EXPECT_EQ(hash(world.state()), start);
  EXPECT_EQ(world.transitions().count, TransitionTable{}.count);
  run(world, 0, 600);
  EXPECT_EQ(hash(world.state()), once);
}

TEST(World, StepsResetsAndRestoresWithoutTheHeap) {
  World world = two_fingers_two_objects();
  const State copy = world.state();
  const std::uint64_t before = test::allocation_count();
  ASSERT_GT(before, 0U);
  run(world, 0, 600);
  static_cast<void>(hash(world.state()));
  world.reset();
  world.restore(copy);
  run(world, 0, 600);
  EXPECT_EQ(test::allocation_count(), before);
}

}  // namespace
}  // namespace haptic::engine
