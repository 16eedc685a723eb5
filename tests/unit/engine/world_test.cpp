// Invariants: what the fingers feel the bodies get, reversed; no input makes the state something other than
// finite numbers.

#include "engine/world.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

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
using test::run;
using test::step;
using test::stroke;
using test::two_fingers_two_objects;
using test::world_of;

TEST(World, StillHipIsMetByAMovingObject) {
  // a frictionless cube slides at 0.1 m/s into a HIP 10 mm before its face: from there on it is a mass on a
  // spring, stepped here with the same scheme, until it has bounced off
  World world = world_of({cube(rigid(), true)}, {finger_of(point_layout())});
  const double mass = 0.04 * 0.04 * 0.04 * 1000.0;
  State state = world.state();
  state.bodies[0].velocity = {0.1, 0.0, 0.0};
  ASSERT_TRUE(world.restore(state));
  double x = 0.0;
  double v = 0.1;
  double force = 0.0;
  double deepest = 0.0;
  for (int i = 0; i < 400; ++i) {
    step(world, at({0.03, 0.0, 0.0}));
    if (i > 0) {
      v += -force / mass * kDt;
      x += v * kDt;
    }
    force = kStiffness * std::max(0.0, x + 0.02 - 0.03);
    deepest = std::max(deepest, force / kStiffness);
    ASSERT_TRUE(near(world.state().hip_forces[0], {force, 0.0, 0.0}, 1e-11)) << i;
    ASSERT_NEAR(world.state().bodies[0].world_from_object.position.x, x, 1e-13) << i;
  }
  // energy: m v^2 = k depth^2
  EXPECT_NEAR(deepest, 0.1 * std::sqrt(mass / kStiffness), 1e-4);
  EXPECT_NEAR(world.state().bodies[0].velocity.x, -0.1, 1e-3);
}

TEST(World, GivesTheBodyTheImpulseThatTheHandGets) {
  // with the centre of gravity off the origin of the object's frame
  const Pose shift{{0.01, -0.02, 0.03}, rotation_by({0.4, 0.5, -0.6})};
  World world =
      world_of({cube(rigid(0.8, 0.5), true, shift)}, {finger_of(fingertip_layout(0.006, 1.0, 7, {1, 0, 0}))});
  const BodyDynamics& body = world.scene().objects[0].dynamics;
  dvec3 impulse{0.0};
  dvec3 angular_impulse{0.0};
  int touched = 0;
  for (int i = 0; i < 3000; ++i) {
    const State& state = world.state();
    // about the centre of gravity, by the force on the user at the HIP
    const dvec3 centre = centre_of_gravity(body, state.bodies[0]);
    for (std::size_t hip = 0; hip < state.hip_forces.size(); ++hip) {
      impulse -= kDt * state.hip_forces[hip];
      angular_impulse -= kDt * glm::cross(state.hip_positions[hip] - centre, state.hip_forces[hip]);
      touched += state.hip_forces[hip] != dvec3{0.0} ? 1 : 0;
    }
    step(world, stroke(i));
    ASSERT_TRUE(near(world.state().bodies[0].velocity * body.mass.mass, impulse, 1e-12)) << i;
    ASSERT_TRUE(near(world.state().bodies[0].angular_momentum, angular_impulse, 1e-13)) << i;
  }
  EXPECT_GT(touched, 50);
  EXPECT_GT(glm::length(impulse), 1e-3);
}

TEST(World, AddsTheForcesOfTwoObjects) {
  const std::vector<Finger> fingers{finger_of(point_layout())};
  World one = world_of({cube(rigid(), false)}, fingers);
  World two = world_of({cube(rigid(), false), cube(rigid(), false)}, fingers);
  for (const double y : {0.03, 0.025, 0.019, 0.015}) {
    step(one, at({0.0, y, 0.003}));
    step(two, at({0.0, y, 0.003}));
  }
  EXPECT_TRUE(near(one.state().hip_forces[0], {0.0, 0.5, 0.0}, 1e-12));  // 5 mm deep
  EXPECT_EQ(two.state().hip_forces[0], 2.0 * one.state().hip_forces[0]);
  EXPECT_EQ(two.state().contact_forces[0], one.state().hip_forces[0]);
  EXPECT_EQ(two.state().contact_forces[1], one.state().hip_forces[0]);
}

TEST(World, FixedObjectNeverMoves) {
  Object fixed = cube(rigid(0.8, 0.5), false);
  fixed.initial_pose = {{0.001, 0.002, 0.003}, rotation_by({0.1, 0.2, 0.3})};
  fixed.dynamics.mass = mass_properties(*fixed.cells, fixed.materials);
  World world = world_of({fixed}, {finger_of(point_layout())}, {0.0, -9.81, 0.0});
  bool touched = false;
  for (int i = 0; i < 2000; ++i) {
    step(world, stroke(i));
    touched = touched || world.state().hip_forces[0] != dvec3{0.0};
    // what it bears is still told
    ASSERT_TRUE(near(world.state().bodies[0].applied.force, -world.state().hip_forces[0], 1e-15));
  }
  EXPECT_TRUE(touched);
  const BodyState& body = world.state().bodies[0];
  EXPECT_EQ(body.world_from_object.position, fixed.initial_pose.position);
  EXPECT_EQ(body.world_from_object.orientation, fixed.initial_pose.orientation);
  EXPECT_EQ(body.velocity, dvec3(0.0));
}

TEST(World, ObjectWithoutMassIsFixed) {
  Material hollow = rigid();
  hollow.density = 0.0;
  World world = world_of({cube(hollow, true)}, {finger_of(point_layout())}, {0.0, -9.81, 0.0});
  for (int i = 0; i < 100; ++i) step(world, stroke(i));
  EXPECT_EQ(world.state().bodies[0].world_from_object.position, dvec3(0.0));
}

TEST(World, HeldObjectFallsOnlyAfterItsRelease) {
  Object object = cube(rigid(), true);
  object.release_after = 0.05;
  World world = world_of({object}, {}, {0.0, -9.81, 0.0});
  for (int tick = 0; tick <= 150; ++tick) {
    world.step({}, kDt);
    // released at tick 50, so it fell for n = tick - 50 steps: g dt^2 n (n + 1) / 2
    const double n = std::max(0, tick - 50);
    const BodyState& body = world.state().bodies[0];
    ASSERT_NEAR(body.world_from_object.position.y, -9.81 * kDt * kDt * n * (n + 1.0) / 2.0, 1e-15) << tick;
    ASSERT_NEAR(body.velocity.y, -9.81 * kDt * n, 1e-14) << tick;
  }
}

TEST(World, FingertipResistsTwistAboutItsNormalAndAPointCannot) {
  // pressed 2 mm into a rough fixed wall from above and twisted about the vertical
  const auto twisted = [](const std::vector<dvec3>& hips) {
    World world = world_of({cube(rigid(1.0, 0.5), false)}, {finger_of(hips)});
    for (int i = 0; i <= 100; ++i) step(world, at({0.0, 0.03 - 0.00004 * i, 0.0}));
    for (int i = 0; i <= 100; ++i) step(world, at({0.0, 0.026, 0.0}, {0.0, 0.0005 * i, 0.0}));
    return world.state().finger_wrenches[0];
  };
  const auto tip = fingertip_layout(0.008, 0.5, 11, {0.0, -1.0, 0.0});
  const Wrench wrench = twisted(tip);
  // all stick: each HIP was turned by 0.05 rad about the normal, so T = -k sum r^2 * sin 0.05
  double arms = 0.0;
  for (const dvec3& hip : tip) arms += hip.x * hip.x + hip.z * hip.z;
  EXPECT_NEAR(wrench.torque.y, -kStiffness * arms * std::sin(0.05), 1e-12);
  EXPECT_GT(wrench.force.y, 1.0);
  EXPECT_NEAR(twisted({{0.0, -0.008, 0.0}}).torque.y, 0.0, 1e-15);
}

TEST(World, NewFingerStartsAtItsHipsWithoutForce) {
  World world = world_of({cube(rigid(), false)}, {finger_of(point_layout())});
  FingerPose finger = at({0.0, 0.01, 0.0});
  finger.present = false;
  step(world, finger);
  EXPECT_EQ(world.state().finger_started[0], 0);
  // appears inside the solid: swallowed, so it feels nothing until it has left
  for (int i = 0; i < 10; ++i) {
    step(world, at({0.0, 0.01, 0.0}));
    EXPECT_TRUE(world.state().proxies[0].swallowed);
    EXPECT_EQ(world.state().hip_forces[0], dvec3(0.0));
  }
  for (const double y : {0.019, 0.021, 0.025}) {
    step(world, at({0.0, y, 0.0}));
    EXPECT_EQ(world.state().hip_forces[0], dvec3(0.0));
  }
  step(world, at({0.0, 0.015, 0.0}));
  EXPECT_TRUE(near(world.state().hip_forces[0], {0.0, 0.5, 0.0}, 1e-12));
}

TEST(World, AbsentFingerHoldsAndFeelsNothing) {
  World world = world_of({cube(rigid(), true)}, {finger_of(point_layout())});
  for (const double y : {0.03, 0.021, 0.018}) step(world, at({0.0, y, 0.0}));
  ASSERT_NE(world.state().hip_forces[0], dvec3(0.0));
  FingerPose finger = at({0.0, 0.018, 0.0});
  finger.present = false;
  step(world, finger);
  EXPECT_EQ(world.state().hip_forces[0], dvec3(0.0));
  EXPECT_EQ(world.state().finger_wrenches[0].force, dvec3(0.0));
  EXPECT_EQ(world.state().bodies[0].applied.force, dvec3(0.0));
  EXPECT_EQ(world.state().proxies[0].state, ConstraintState::kOut);
  const dvec3 velocity = world.state().bodies[0].velocity;
  for (int i = 0; i < 10; ++i) step(world, finger);
  EXPECT_EQ(world.state().bodies[0].velocity, velocity);
  // and comes back far off: no path from where it was
  step(world, at({0.0, -0.03, 0.0}));
  EXPECT_EQ(world.state().hip_forces[0], dvec3(0.0));
}

bool all_finite(const State& state) {
  bool finite = true;
  const auto look = [&](const dvec3& v) { finite = finite && std::isfinite(v.x + v.y + v.z); };
  for (const BodyState& body : state.bodies) {
    look(body.world_from_object.position);
    look(body.velocity);
    look(body.angular_momentum);
    look(body.applied.force);
    look(body.applied.torque);
    const glm::dquat& q = body.world_from_object.orientation;
    finite = finite && std::isfinite(q.w + q.x + q.y + q.z);
  }
  for (const Proxy& proxy : state.proxies) look(proxy.position);
  for (const dvec3& v : state.contact_forces) look(v);
  for (const dvec3& v : state.hip_positions) look(v);
  for (const dvec3& v : state.hip_forces) look(v);
  for (const Wrench& wrench : state.finger_wrenches) {
    look(wrench.force);
    look(wrench.torque);
  }
  return finite;
}

TEST(World, TreatsABrokenPoseAsAnAbsentFinger) {
  World world =
      world_of({cube(rigid(0.8, 0.5), true)}, {finger_of(fingertip_layout(0.006, 1.0, 7, {1, 0, 0}))});
  const double infinity = std::numeric_limits<double>::infinity();
  const double largest = std::numeric_limits<double>::max();
  int tick = 0;
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), infinity, -infinity, largest, 1e150, -1e7}) {
    for (int field = 0; field < 7; ++field) {
      for (int i = 0; i < 40; ++i) step(world, stroke(tick++));
      FingerPose broken = stroke(tick++);
      if (field < 3) {
        broken.world_from_device.position[field] = bad;
      } else {
        broken.world_from_device.orientation[field - 3] = bad;
      }
      step(world, broken);
      ASSERT_TRUE(all_finite(world.state())) << bad << ' ' << field;
      ASSERT_EQ(world.state().finger_started[0], 0) << bad << ' ' << field;
      ASSERT_EQ(world.state().finger_wrenches[0].force, dvec3(0.0));
    }
  }
  // and the finger works on
  EXPECT_EQ(world.state().ticks, static_cast<std::uint64_t>(42 * 41));
  step(world, stroke(tick));
  EXPECT_EQ(world.state().finger_started[0], 1);
}

TEST(World, StaysFiniteUnderWildFingersAnywhereWithinReach) {
  World world =
      world_of({cube(rigid(0.8, 0.5), true)}, {finger_of(fingertip_layout(0.006, 1.0, 7, {1, 0, 0}))});
  std::uint64_t seed = 1;
  const auto random = [&seed] {
    seed = seed * 6364136223846793005U + 1442695040888963407U;
    return static_cast<double>(seed >> 11) * 0x1p-53 - 0.5;
  };
  for (int i = 0; i < 5000; ++i) {
    const double size = std::pow(10.0, 12.0 * random());  // up to 1e6 m
    step(world, at(size * dvec3{random(), random(), random()}, 10.0 * dvec3{random(), random(), random()}));
    ASSERT_TRUE(all_finite(world.state())) << i;
  }
}

TEST(World, DoesFarFromAnObjectWhatTheStateMachineWouldDo) {
  // one path that wanders near, past and into the complex, once through a world and once by hand
  World world = world_of({cube(rigid(0.8, 0.5), false)}, {finger_of(point_layout())});
  const Object& object = world.scene().objects[0];
  const ConstraintModel model{*object.cells, object.materials};
  Proxy proxy;
  TransitionTable table;
  std::uint64_t seed = 3;
  const auto random = [&seed] {
    seed = seed * 6364136223846793005U + 1442695040888963407U;
    return static_cast<double>(seed >> 11) * 0x1p-53 - 0.5;
  };
  int outside = 0;
  dvec3 hip{0.1, 0.0, 0.0};
  for (int i = 0; i < 20000; ++i) {
    // now and then it stands still; mostly it jumps by centimetres, drawn back to the middle
    if (random() > -0.4) hip = 0.9 * hip + 0.05 * dvec3{random(), random(), random()};
    step(world, at(hip));
    if (i == 0) {
      start_proxy(model, hip, proxy);
    } else {
      constrain(model, hip, kStiffness, kDt, proxy, table);
    }
    const Proxy& actual = world.state().proxies[0];
    ASSERT_EQ(actual.position, proxy.position) << i;
    ASSERT_EQ(actual.state, proxy.state) << i;
    ASSERT_EQ(actual.cell, proxy.cell) << i;
    ASSERT_EQ(actual.feature, proxy.feature) << i;
    ASSERT_EQ(actual.slipping, proxy.slipping) << i;
    ASSERT_EQ(actual.swallowed, proxy.swallowed) << i;
    outside += proxy.state == ConstraintState::kOut ? 1 : 0;
  }
  EXPECT_EQ(world.transitions().count, table.count);
  EXPECT_GT(outside, 2000);
  EXPECT_LT(outside, 18000);
}

TEST(World, TellsWhereAProxyIsInTheWorld) {
  World world = two_fingers_two_objects();
  run(world, 0, 800);
  const State& state = world.state();
  for (std::size_t object = 0; object < 2; ++object) {
    for (std::size_t hip = 0; hip < 8; ++hip) {
      // the force is k (q - p)
      const dvec3 force = kStiffness * (world.proxy_in_world(object, hip) - state.hip_positions[hip]);
      EXPECT_TRUE(near(state.contact_forces[object * 8 + hip], force, 1e-12));
    }
  }
}

}  // namespace
}  // namespace haptic::engine
