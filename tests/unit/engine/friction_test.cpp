// Materials through the state machine: Coulomb friction (paper eq. 4), yield (eq. 3) and viscous drag.

#include <gtest/gtest.h>

#include <cmath>
#include <glm/vector_relational.hpp>

#include "engine/constraint.h"
#include "engine/shapes.h"
#include "tests/support/expect_vector.h"
#include "tests/support/meshes.h"
#include "tests/support/probe.h"

namespace haptic::engine {
namespace {

using glm::dvec3;
using test::air;
using test::near;
using test::Probe;
using test::rigid;
using test::viscous;
using test::yielding;

/// A cube of 100 mm around the origin in 50 mm of air.
const TetraMesh cube_mesh = test::kuhn_grid({4, 4, 4}, dvec3(-0.1), dvec3(0.1), [](const dvec3& p) {
  return glm::all(glm::lessThan(glm::abs(p), dvec3(0.05))) ? 1 : 0;
});

Probe cube(const Material& solid, const dvec3& start) {
  return {CellComplex::build(cube_mesh), {air(), solid}, start};
}

/// A HIP that rests `depth` below the top face of a rigid cube, its proxy above it and at rest.
Probe pressed(const Material& solid, double depth, const dvec3& at = {0.0, 0.05, 0.0}) {
  Probe probe = cube(solid, at + dvec3(0.0, 0.001, 0.0));
  probe.move_to(at - dvec3(0.0, depth, 0.0));
  probe.move_to(at - dvec3(0.0, depth, 0.0));
  return probe;
}

double tangential_over_normal(const dvec3& force) { return std::hypot(force.x, force.z) / force.y; }

TEST(Friction, SticksUpToExactlyTheStaticCoefficient) {
  const double depth = 0.002, mu_s = 0.8;
  Probe probe = pressed(rigid(mu_s, 0.3), depth);
  const dvec3 held = probe.proxy().position;
  EXPECT_EQ(probe.move_to({mu_s * depth * (1.0 - 1e-7), 0.05 - depth, 0.0}), held);
}

TEST(Friction, SlipsBeyondExactlyTheStaticCoefficient) {
  const double depth = 0.002, mu_s = 0.8;
  Probe probe = pressed(rigid(mu_s, 0.3), depth);
  const dvec3 held = probe.proxy().position;
  EXPECT_NE(probe.move_to({mu_s * depth * (1.0 + 1e-7), 0.05 - depth, 0.0}), held);
}

TEST(Friction, FirstSlipKeepsTheStaticRatioAndEveryLaterOneTheKinetic) {
  const double depth = 0.002;
  Probe probe = pressed(rigid(0.8, 0.3), depth);
  probe.move_to({0.003, 0.05 - depth, 0.001});
  EXPECT_NEAR(tangential_over_normal(probe.force()), 0.8, 1e-9);
  for (int i = 0; i < 50; ++i) {
    probe.move_to({0.003 + 1e-4 * i, 0.05 - depth, 0.001 - 2e-4 * i});
    ASSERT_NEAR(tangential_over_normal(probe.force()), 0.3, 1e-9) << "tick " << i;
  }
}

TEST(Friction, ForceOpposesTheMotionOfTheHip) {
  Probe probe = pressed(rigid(0.5, 0.5), 0.002);
  probe.move_to({0.004, 0.048, 0.003});
  const dvec3 force = probe.force();
  EXPECT_NEAR(force.x / force.z, 4.0 / 3.0, 1e-9);
  EXPECT_LT(force.x, 0.0);
}

TEST(Friction, ProxyAtRestSticksAgain) {
  const double depth = 0.002;
  Probe probe = pressed(rigid(0.8, 0.3), depth);
  probe.move_to({0.003, 0.05 - depth, 0.0});
  probe.move_to({0.004, 0.05 - depth, 0.0});
  const dvec3 slid = probe.move_to({0.004, 0.05 - depth, 0.0});
  EXPECT_FALSE(probe.proxy().slipping);
  // now 0.3 x depth behind; up to 0.8 x depth it is held again
  EXPECT_EQ(probe.move_to({0.004 + 0.49 * depth, 0.05 - depth, 0.0}), slid);
  EXPECT_NE(probe.move_to({0.004 + 0.51 * depth, 0.05 - depth, 0.0}), slid);
}

TEST(Friction, ProxyRemembersThePathThatLedTheHipToItsPlace) {
  // A HIP that slid along the floor leaves its proxy mu x depth behind, here 7.5 mm; one that came from above
  // does not.
  const double mu = 0.5;
  Probe along_floor = cube(rigid(mu, mu), {0.04, 0.051, 0.0});
  along_floor.move_to({0.04, 0.035, 0.0});
  along_floor.drag_to({0.0, 0.035, 0.0}, 40);
  EXPECT_NEAR(along_floor.proxy().position.x, mu * 0.015, 1e-12);
  Probe from_above = cube(rigid(mu, mu), {0.0, 0.051, 0.0});
  from_above.drag_to({0.0, 0.035, 0.0}, 40);
  EXPECT_NEAR(from_above.proxy().position.x, 0.0, 1e-12);
}

TEST(Yield, ProxyStaysBehindByExactlyTheThreshold) {
  Probe probe = cube(yielding(0.1), {0.0, 0.06, 0.0});
  probe.drag_to({0.0, 0.03, 0.0}, 30);
  EXPECT_TRUE(near(probe.force(), {0.0, 0.1, 0.0}, 1e-9));
  EXPECT_TRUE(near(probe.proxy().position, {0.0, 0.031, 0.0}, 1e-12));  // F/k = 0.1 N / 100 N/m
  EXPECT_EQ(probe.proxy().state, ConstraintState::kTet);
}

TEST(Yield, SurfaceHoldsUpToTheThreshold) {
  Probe probe = cube(yielding(0.1), {0.013, 0.06, 0.007});
  probe.drag_to({0.013, 0.0491, 0.007}, 30);  // 0.9 mm deep: 0.09 N
  EXPECT_EQ(probe.proxy().state, ConstraintState::kSur);
  EXPECT_TRUE(near(probe.force(), {0.0, 0.09, 0.0}, 1e-9));
}

TEST(Yield, ForceInsideNeverExceedsTheThreshold) {
  Probe probe = cube(yielding(0.1), {0.0, 0.06, 0.0});
  probe.drag_to({0.0, 0.02, 0.0}, 40);
  for (int i = 0; i < 3000; ++i) {
    const double t = 1e-3 * i;
    probe.move_to({0.03 * std::sin(7.0 * t), 0.02 - 0.02 * std::sin(3.1 * t), 0.03 * std::sin(5.3 * t)});
    ASSERT_LE(glm::length(probe.force()), 0.1 + 1e-9);
  }
}

TEST(Viscous, LagOfAStepDecaysWithDragOverStiffness) {
  const double drag = 2.0, stiffness = 100.0, step = 0.01;
  Probe probe = cube(viscous(drag), {0.0, 0.0, 0.0});
  const dvec3 goal{step * 0.6, step * 0.64, step * 0.48};  // |goal| = step
  for (int tick = 1; tick <= 60; ++tick) {
    probe.move_to(goal);
    const double expected = step * std::exp(-stiffness * 1e-3 * tick / drag);
    ASSERT_NEAR(glm::distance(probe.proxy().position, goal), expected, 1e-14) << "tick " << tick;
  }
}

TEST(Viscous, TimeSpentInOneCellIsMissingInTheNext) {
  // the same decay whether the way crosses many cells or none: a tick has 1 ms, however often it is cut
  Probe probe(CellComplex::build(icosphere_mesh(0.05, 3, 0.01)), {air(), viscous(2.0)},
              {-0.03, 0.001, 0.002});
  const dvec3 start = probe.proxy().position, goal{0.03, 0.004, -0.003};
  for (int tick = 1; tick <= 40; ++tick) {
    probe.move_to(goal);
    const double expected = glm::distance(start, goal) * std::exp(-100.0 * 1e-3 * tick / 2.0);
    ASSERT_NEAR(glm::distance(probe.proxy().position, goal), expected, 1e-12) << "tick " << tick;
  }
}

TEST(Viscous, YieldingMaterialWithDragSettlesAtItsThreshold) {
  Probe probe =
      cube(yielding(0.2, 0.5), {0.0, 0.0, 0.0});  // starts inside: a yielding material may be entered
  EXPECT_FALSE(probe.proxy().swallowed);
  for (int tick = 0; tick < 400; ++tick) probe.move_to({0.02, 0.01, 0.0});
  // motions shorter than the tolerance (3.5e-12 m) end the approach a little early
  EXPECT_NEAR(glm::length(probe.force()), 0.2, 1e-8);
}

}  // namespace
}  // namespace haptic::engine
