// An edited world goes on from the last instant of the one before. Invariant: what no edit touches has the
// same bits as if there had been none.

#include "engine/carry_map.h"

#include <gtest/gtest.h>

#include "tests/support/expect_vector.h"
#include "tests/support/small_world.h"

namespace haptic::engine {
namespace {

using glm::dvec3;
using test::at;
using test::cube;
using test::finger_of;
using test::kDt;
using test::kStiffness;
using test::near;
using test::rigid;
using test::step;
using test::world_of;

Object far_away(const Object& object) {
  Object far = object;
  far.initial_pose.position.x += 10.0;
  return far;
}

/// The world of `after`, gone on from `before`; objects and fingers come from where they are told.
World edited(const World& before, const Scene& after, const std::vector<Index>& objects,
             const std::vector<Index>& fingers) {
  auto scene = std::make_shared<Scene>(after);
  number_hips(*scene);
  World world(scene);
  EXPECT_TRUE(world.carry_over(before, make_carry_map(before.scene(), *scene, objects, fingers)));
  return world;
}

/// One point finger that presses 5 mm into a cube from +x, and feels 0.5 N.
World pressed(const Object& object) {
  World world = world_of({object}, {finger_of(point_layout())});
  step(world, at({0.03, 0.0, 0.0}));
  step(world, at({0.015, 0.0, 0.0}));
  EXPECT_TRUE(near(world.state().hip_forces[0], {0.5, 0.0, 0.0}, 1e-12));
  return world;
}

TEST(CarryMap, AnEditElsewhereChangesNoBitOfWhatGoesOn) {
  World plain = test::two_fingers_two_objects();
  test::run(plain, 0, 3000);

  World world = test::two_fingers_two_objects();
  const Scene scene = world.scene();
  test::run(world, 0, 1000);
  // a cube comes before the others, and a finger before the other two
  Scene wider = scene;
  wider.objects.insert(wider.objects.begin(), far_away(scene.objects[0]));
  wider.fingers.insert(wider.fingers.begin(), finger_of(point_layout()));
  World more = edited(world, wider, {kNone, 0, 1}, {kNone, 0, 1});
  for (int i = 1000; i < 2000; ++i) {
    const std::array fingers{at({0.0, 5.0, 0.0}), test::stroke(i), test::stroke(3 * i + 1000)};
    more.step(fingers, kDt);
  }
  // and both go again
  World again = edited(more, scene, {1, 2}, {1, 2});
  test::run(again, 2000, 3000);
  EXPECT_EQ(hash(again.state()), hash(plain.state()));
  EXPECT_EQ(again.state().ticks, 3000u);
}

TEST(CarryMap, AnEditOfNothingIsTheSameInstant) {
  World world = test::two_fingers_two_objects();
  test::run(world, 0, 1234);
  const World same = edited(world, world.scene(), {0, 1}, {0, 1});
  EXPECT_EQ(hash(same.state()), hash(world.state()));
  EXPECT_EQ(same.transitions().count, world.transitions().count);
}

TEST(CarryMap, AnObjectThatAppearsAroundAHipSwallowsItUntilItHasLeft) {
  World empty = world_of({}, {finger_of(point_layout())});
  for (int i = 0; i < 10; ++i) step(empty, at({0.005, 0.0, 0.0}));
  Scene scene = empty.scene();
  scene.objects.push_back(cube(rigid(), false));
  World world = edited(empty, scene, {kNone}, {0});
  for (int i = 0; i < 15; ++i) {
    step(world, at({0.005 + 0.001 * i, 0.0, 0.0}));
    ASSERT_EQ(world.state().hip_forces[0], dvec3(0.0)) << i;
  }
  EXPECT_TRUE(world.state().proxies[0].swallowed);
  // out through the face at 20 mm, and 5 mm in again
  step(world, at({0.025, 0.0, 0.0}));
  step(world, at({0.015, 0.0, 0.0}));
  EXPECT_TRUE(near(world.state().hip_forces[0], {0.005 * kStiffness, 0.0, 0.0}, 1e-12));
}

TEST(CarryMap, ARemovedObjectLeavesNoForce) {
  World world = pressed(cube(rigid(), false));
  Scene scene = world.scene();
  scene.objects.clear();
  World empty = edited(world, scene, {}, {0});
  EXPECT_EQ(empty.state().hip_forces[0], dvec3(0.0));
  step(empty, at({0.015, 0.0, 0.0}));
  EXPECT_EQ(empty.state().finger_wrenches[0].force, dvec3(0.0));
}

TEST(CarryMap, AnObjectThatWasPutElsewhereStartsThereAtRestAndSwallows) {
  World world = world_of({cube(rigid(), true)}, {finger_of(point_layout())});
  State state = world.state();
  state.bodies[0].velocity = {0.1, 0.0, 0.0};
  ASSERT_TRUE(world.restore(state));
  step(world, at({0.5, 0.0, 0.0}));
  Scene scene = world.scene();
  scene.objects[0].initial_pose.position = {0.49, 0.0, 0.0};
  World moved = edited(world, scene, {kNone}, {0});
  step(moved, at({0.5, 0.0, 0.0}));
  EXPECT_EQ(moved.state().bodies[0].world_from_object.position, dvec3(0.49, 0.0, 0.0));
  EXPECT_EQ(moved.state().bodies[0].velocity, dvec3(0.0));
  EXPECT_TRUE(moved.state().proxies[0].swallowed);
}

TEST(CarryMap, ANewBodyFallsFromTheInstantAtWhichItJoins) {
  World empty = world_of({}, {}, {0.0, -9.81, 0.0});
  for (int i = 0; i < 10; ++i) empty.step({}, kDt);
  Scene scene = empty.scene();
  scene.objects.push_back(cube(rigid(), true));
  World world = edited(empty, scene, {kNone}, {});
  EXPECT_EQ(world.state().bodies[0].world_from_object.position, dvec3(0.0));
  for (int i = 0; i < 5; ++i) world.step({}, kDt);
  EXPECT_NEAR(world.state().bodies[0].velocity.y, -5 * 9.81 * kDt, 1e-15);
}

TEST(CarryMap, AnEditDoesNotHoldABodyAgain) {
  Object late = cube(rigid(), true);
  late.release_after = 0.1;
  World world = world_of({late}, {}, {0.0, -9.81, 0.0});
  for (int i = 0; i < 60; ++i) world.step({}, kDt);
  World again = edited(world, world.scene(), {0}, {});
  // tick n is at n ms; the first motion goes from tick 100 to 101
  for (int i = 60; i <= 100; ++i) again.step({}, kDt);
  EXPECT_EQ(again.state().bodies[0].velocity.y, 0.0);
  again.step({}, kDt);
  EXPECT_LT(again.state().bodies[0].velocity.y, 0.0);
}

TEST(CarryMap, OtherFrictionKeepsTheContact) {
  World world = pressed(cube(rigid(), false));
  Scene scene = world.scene();
  scene.objects[0].materials[1] = rigid(0.8, 0.5);
  World other = edited(world, scene, {0}, {0});
  step(other, at({0.015, 0.0, 0.0}));
  EXPECT_TRUE(near(other.state().hip_forces[0], {0.5, 0.0, 0.0}, 1e-12));
}

TEST(CarryMap, MaterialThatBecomesRigidSwallowsWhatIsInIt) {
  World world = world_of({cube(Material{}, false)}, {finger_of(point_layout())});
  for (int i = 0; i < 3; ++i) step(world, at({0.005, 0.0, 0.0}));
  Scene scene = world.scene();
  scene.objects[0].materials[1] = rigid();
  World solid = edited(world, scene, {0}, {0});
  step(solid, at({0.006, 0.001, 0.0}));
  EXPECT_TRUE(solid.state().proxies[0].swallowed);
  EXPECT_EQ(solid.state().hip_forces[0], dvec3(0.0));
}

TEST(CarryMap, ABodyOfAnotherMassOrThatIsFixedStopsWhereItIs) {
  World world = world_of({cube(rigid(), true)}, {});
  State state = world.state();
  state.bodies[0].velocity = {0.1, 0.0, 0.0};
  ASSERT_TRUE(world.restore(state));
  for (int i = 0; i < 5; ++i) world.step({}, kDt);
  const dvec3 place = world.state().bodies[0].world_from_object.position;
  ASSERT_GT(place.x, 0.0);
  Scene heavy = world.scene();
  heavy.objects[0].dynamics.mass.mass *= 2.0;
  Scene fixed = world.scene();
  fixed.objects[0].dynamic = false;
  for (const Scene& scene : {heavy, fixed}) {
    World stopped = edited(world, scene, {0}, {});
    stopped.step({}, kDt);
    EXPECT_EQ(stopped.state().bodies[0].world_from_object.position, place);
  }
}

TEST(CarryMap, AFingerOnAnotherDeviceStartsAnew) {
  World world = pressed(cube(rigid(), false));
  Scene scene = world.scene();
  scene.fingers[0].device = "another";
  World other = edited(world, scene, {0}, {0});
  step(other, at({0.015, 0.0, 0.0}));
  EXPECT_TRUE(other.state().proxies[0].swallowed);
}

TEST(CarryMap, OfAnotherWorldIsRefusedAndChangesNothing) {
  World world = pressed(cube(rigid(), false));
  const World before = pressed(cube(rigid(), false));  // cells of its own
  const std::uint64_t unchanged = hash(world.state());
  const CarriedObject none;
  for (const CarryMap& map :
       {CarryMap{{}, {0}}, CarryMap{{none}, {}}, CarryMap{{none}, {1}}, CarryMap{{{.from = 1}}, {0}},
        CarryMap{{none, none}, {0}}, CarryMap{{{.from = 0, .motion = true, .contacts = true}}, {0}}}) {
    EXPECT_FALSE(world.carry_over(before, map));
    EXPECT_EQ(hash(world.state()), unchanged);
  }
}

}  // namespace
}  // namespace haptic::engine
