// The state machine against closed forms. Shapes are boxes and prisms whose faces lie on known planes, so
// that the proxy must be at a foot, on an edge or on a corner that the test can name.

#include "engine/constraint.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/vector_relational.hpp>

#include "engine/constants.h"
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

constexpr double kExact = 1e-12;  // m; rounding of coordinates of some centimetres, with room

/// A cube of 100 mm around the origin (region 1) in 50 mm of something else (region 0), in Kuhn's cells of 50
/// mm.
TetraMesh cube_mesh() {
  return test::kuhn_grid({4, 4, 4}, dvec3(-0.1), dvec3(0.1), [](const dvec3& p) {
    return glm::all(glm::lessThan(glm::abs(p), dvec3(0.05))) ? 1 : 0;
  });
}

/// A rigid cube in air: its faces are at +-50 mm.
Probe cube(const dvec3& start, const Material& solid = rigid()) {
  return {CellComplex::build(cube_mesh()), {air(), solid}, start};
}

/// An air-filled room in rigid rock.
Probe room(const dvec3& start, const Material& rock = rigid()) {
  return {CellComplex::build(cube_mesh()), {rock, air()}, start};
}

/// A rigid L-shaped prism along z: floor to y = 20 mm, wall to x = 20 mm, the notch edge between them at (20,
/// 20) mm.
Probe notch(const dvec3& start, const Material& solid = rigid()) {
  const std::array<glm::dvec2, 6> outline{
      {{0.0, 0.0}, {0.1, 0.0}, {0.1, 0.02}, {0.02, 0.02}, {0.02, 0.1}, {0.0, 0.1}}};
  return {CellComplex::build(extrusion_mesh(outline, 0.1, 0.05)), {air(), solid}, start};
}

TEST(Constraint, FreeProxyFollowsItsHip) {
  Probe probe = cube({0.0, 0.06, 0.0});
  EXPECT_TRUE(near(probe.drag_to({0.03, 0.08, 0.02}, 20), {0.03, 0.08, 0.02}, kExact));
  EXPECT_EQ(probe.proxy().state, ConstraintState::kTet);
}

TEST(Constraint, FaceHoldsTheProxyAtTheFootOfTheHip) {
  Probe probe = cube({0.01, 0.06, 0.02});
  EXPECT_TRUE(near(probe.drag_to({0.01, 0.04, 0.02}, 20), {0.01, 0.05, 0.02}, kExact));
  EXPECT_EQ(probe.proxy().state, ConstraintState::kSur);
  EXPECT_TRUE(near(probe.force(), {0.0, 1.0, 0.0}, 1e-9));  // 100 N/m x 10 mm
}

TEST(Constraint, FrictionlessProxySlidesAlongTheFaceWithTheHip) {
  Probe probe = cube({-0.04, 0.06, -0.03});
  probe.drag_to({-0.04, 0.045, -0.03}, 10);
  EXPECT_TRUE(near(probe.drag_to({0.04, 0.045, 0.03}, 100), {0.04, 0.05, 0.03}, kExact));
}

TEST(Constraint, HipThatPassesTheConvexEdgeInsideTheSolidTakesTheProxyRoundIt) {
  // 2 mm below the top, from the top face past the edge at x = 50 mm into the air beyond: nothing holds it
  // there
  Probe probe = cube({0.04, 0.06, 0.0});
  probe.drag_to({0.04, 0.048, 0.0}, 10);
  EXPECT_TRUE(near(probe.drag_to({0.06, 0.048, 0.0}, 20), {0.06, 0.048, 0.0}, kExact));
}

TEST(Constraint, HipExactlyInThePlaneOfTheNextFaceIsNotHeldAtTheRim) {
  // The foot coincides with the proxy on the rim of the top face; a machine that rests there never looks
  // round the edge and holds a HIP that is free.
  Probe probe = cube({0.04, 0.06, 0.0});
  probe.drag_to({0.04, 0.04, 0.0}, 10);
  EXPECT_TRUE(near(probe.move_to({0.05, 0.0167, 0.0}), {0.05, 0.0167, 0.0}, kExact));
}

TEST(Constraint, PressingDiagonallyOverAConvexEdgeIsHeldByTheNearerFace) {
  Probe probe = cube({0.06, 0.062, 0.0});
  probe.drag_to({0.04, 0.042, 0.0}, 40);  // 8 mm below the top, 10 mm inside the +x face
  EXPECT_TRUE(near(probe.proxy().position, {0.04, 0.05, 0.0}, kExact) ||
              near(probe.proxy().position, {0.05, 0.042, 0.0}, kExact));
}

TEST(Constraint, ConcaveEdgeHoldsTheProxyWhereTheHipProjectsOnIt) {
  Probe probe = notch({0.05, 0.05, 0.0});
  EXPECT_TRUE(near(probe.drag_to({0.01, 0.005, 0.013}, 50), {0.02, 0.02, 0.013}, kExact));
  EXPECT_EQ(probe.proxy().state, ConstraintState::kEdg);
  EXPECT_TRUE(near(probe.force(), {1.0, 1.5, 0.0}, 1e-9));  // no component along the edge
}

TEST(Constraint, ProxyLeavesTheConcaveEdgeAlongTheFloorWhenTheHipLeavesTheWall) {
  Probe probe = notch({0.05, 0.05, 0.0});
  probe.drag_to({0.01, 0.005, 0.0}, 50);
  EXPECT_TRUE(near(probe.move_to({0.03, 0.005, 0.0}), {0.03, 0.02, 0.0}, kExact));
  EXPECT_EQ(probe.proxy().state, ConstraintState::kSur);
}

TEST(Constraint, ConcaveCornerHoldsTheProxyOnItsVertex) {
  Probe probe = room({0.0, 0.0, 0.0});
  EXPECT_TRUE(near(probe.drag_to({0.055, 0.06, 0.065}, 60), {0.05, 0.05, 0.05}, kExact));
  EXPECT_EQ(probe.proxy().state, ConstraintState::kVer);
  EXPECT_TRUE(near(probe.force(), {-0.5, -1.0, -1.5}, 1e-9));
}

TEST(Constraint, ProxyLeavesTheCornerAlongAnEdge) {
  Probe probe = room({0.0, 0.0, 0.0});
  probe.drag_to({0.06, 0.06, 0.06}, 60);
  EXPECT_TRUE(near(probe.move_to({0.06, 0.06, 0.031}), {0.05, 0.05, 0.031}, kExact));
  EXPECT_EQ(probe.proxy().state, ConstraintState::kEdg);
}

TEST(Constraint, FreeRegionThatIsConvexGivesTheEuclideanProjectionOnWhateverPath) {
  // the nearest point of a box is the clamped point
  Probe probe = room({0.001, 0.002, 0.003});
  std::uint64_t seed = 1;
  const auto random = [&seed] {
    seed = seed * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<double>(seed >> 11) * 0x1p-53 - 0.5;
  };
  for (int i = 0; i < 20000; ++i) {
    const dvec3 hip{0.18 * random(), 0.18 * random(), 0.18 * random()};
    ASSERT_TRUE(near(probe.move_to(hip), glm::clamp(hip, dvec3(-0.05), dvec3(0.05)), kExact)) << "tick " << i;
  }
}

class SphereFaces : public ::testing::TestWithParam<int> {};

TEST_P(SphereFaces, HoldTheProxyAtTheFootOfAHipUnderTheirCentre) {
  const double radius = 0.02;
  const CellComplex complex = CellComplex::build(icosphere_mesh(radius, GetParam(), 0.02));
  int pressed = 0;
  for (std::size_t f = 0; f < complex.faces().size(); ++f) {
    const Face& face = complex.faces()[f];
    if (face.cells[1] == kNone) continue;
    if (complex.cells()[face.cells[0]].region == complex.cells()[face.cells[1]].region) continue;
    const FaceRim& rim = complex.rims()[f];
    const auto vertices = complex.vertices();
    const dvec3 a = vertices[rim.vertices[0]], b = vertices[rim.vertices[1]], c = vertices[rim.vertices[2]];
    const dvec3 centre = (a + b + c) / 3.0;
    const dvec3 outward = glm::normalize(centre);
    const dvec3 normal = glm::normalize(glm::cross(b - a, c - a));
    Probe probe(complex, {air(), rigid()}, centre + 0.005 * outward);
    const dvec3 hip = centre - 0.001 * outward;
    const dvec3 foot = hip - glm::dot(hip - a, normal) * normal;
    ASSERT_TRUE(near(probe.drag_to(hip, 6), foot, kExact)) << "face " << f;
    ++pressed;
  }
  EXPECT_EQ(pressed, 20 << (2 * GetParam()));  // every triangle of the surface was tried
}

INSTANTIATE_TEST_SUITE_P(OfEachSize, SphereFaces, ::testing::Values(0, 1, 2));

TEST(Constraint, ThinPlateCrossedAtFiveMetresASecondIsNotPassedThrough) {
  // 0.5 mm thick, 5 mm a tick: one tick ends above it, the next one below
  Probe probe(CellComplex::build(box_mesh({0.1, 0.0005, 0.1}, 0.02)), {air(), rigid()}, {0.01, 0.0125, 0.02});
  probe.drag_to({0.01, -0.0075, 0.02}, 4);
  EXPECT_TRUE(near(probe.proxy().position, {0.01, 0.00025, 0.02}, kExact));
  EXPECT_NEAR(probe.force().y, 100.0 * 0.00775, 1e-9);
}

TEST(Constraint, SolidWithoutAirCellsIsMetOnTheWayInFromOutside) {
  Probe probe(CellComplex::build(box_mesh({0.1, 0.1, 0.1}, 0.0)), {rigid()}, {0.01, 0.2, 0.02});
  EXPECT_EQ(probe.proxy().state, ConstraintState::kOut);
  EXPECT_TRUE(near(probe.move_to({0.01, 0.03, 0.02}), {0.01, 0.05, 0.02}, kExact));
  EXPECT_TRUE(near(probe.drag_to({0.03, 0.04, -0.02}, 10), {0.03, 0.05, -0.02}, kExact));
}

TEST(Constraint, ProxyThatLeavesTheHullIsTheHipAgain) {
  Probe probe(CellComplex::build(box_mesh({0.1, 0.1, 0.1}, 0.0)), {rigid()}, {0.01, 0.2, 0.02});
  probe.move_to({0.01, 0.03, 0.02});
  EXPECT_TRUE(near(probe.move_to({0.01, 0.07, 0.02}), {0.01, 0.07, 0.02}, kExact));
  EXPECT_EQ(probe.proxy().state, ConstraintState::kOut);
}

TEST(Constraint, AirCellsAroundASolidChangeNoForce) {
  Probe bare(CellComplex::build(box_mesh({0.1, 0.1, 0.1}, 0.0)), {rigid(0.6, 0.4)}, {0.0, 0.08, 0.0});
  Probe wrapped = cube({0.0, 0.08, 0.0}, rigid(0.6, 0.4));
  // a stroke over a face, round an edge and away again, irrational in every direction
  for (int i = 0; i < 4000; ++i) {
    const double t = 1e-3 * i;
    const dvec3 hip{0.06 * std::sin(1.7 * t), 0.058 * std::cos(0.9 * t), 0.04 * std::sin(2.3 * t + 1.0)};
    bare.move_to(hip);
    wrapped.move_to(hip);
    ASSERT_TRUE(near(bare.force(), wrapped.force(), 1e-9)) << "tick " << i;
  }
}

TEST(Constraint, HipThatStartsInsideRigidMaterialIsSwallowedUntilItHasLeft) {
  Probe probe = cube({0.0, 0.03, 0.0});
  EXPECT_TRUE(probe.proxy().swallowed);
  probe.drag_to({0.02, 0.045, 0.01}, 10);
  EXPECT_EQ(probe.force(), dvec3(0.0));
  probe.drag_to({0.02, 0.06, 0.01}, 10);
  EXPECT_FALSE(probe.proxy().swallowed);
  EXPECT_TRUE(near(probe.drag_to({0.02, 0.045, 0.01}, 10), {0.02, 0.05, 0.01}, kExact));
}

TEST(Constraint, HipThatStartsOnTheSurfaceIsNotSwallowed) {
  Probe probe = cube({0.01, 0.05, 0.02});
  EXPECT_FALSE(probe.proxy().swallowed);
  EXPECT_TRUE(near(probe.drag_to({0.01, 0.04, 0.02}, 5), {0.01, 0.05, 0.02}, kExact));
}

TEST(Constraint, SlippingTellsWhetherTheProxyMovedInTheTick) {
  Probe probe = cube({0.01, 0.06, 0.02}, rigid(1.0, 1.0));
  probe.drag_to({0.01, 0.04, 0.02}, 10);
  probe.move_to({0.01, 0.04, 0.02});
  EXPECT_FALSE(probe.proxy().slipping);
  probe.move_to({0.04, 0.04, 0.02});
  EXPECT_TRUE(probe.proxy().slipping);
}

TEST(Constraint, EveryTransitionIsCountedAndTimedWhenAClockIsLent) {
  const CellComplex complex = CellComplex::build(cube_mesh());
  const std::vector<Material> materials{air(), rigid()};
  Proxy proxy;
  TransitionTable table;
  start_proxy({complex, materials}, {0.0, 0.06, 0.0}, proxy);
  constexpr Clock kTenNanosecondsACall = []() noexcept {
    static std::uint64_t now = 0;
    return now += 10;
  };
  constrain({complex, materials}, {0.013, 0.04, 0.007}, 100.0, 1e-3, proxy, table, kTenNanosecondsACall);
  const auto tet = static_cast<std::size_t>(ConstraintState::kTet);
  const auto sur = static_cast<std::size_t>(ConstraintState::kSur);
  EXPECT_GE(table.count[tet][sur], 1U);
  EXPECT_GE(table.count[sur][sur], 1U);
  EXPECT_EQ(table.timed, table.count);
  EXPECT_EQ(table.nanoseconds[sur][sur], 10 * table.count[sur][sur]);
}

TEST(Constraint, TransitionBoundLeavesTheProxyOnItsWayAndIsCounted) {
  // 2000 cubes in a row have some 6000 faces across the path of one tick, and each takes two transitions: the
  // bound stops the proxy between them, closer to the HIP than it was, and the next tick goes on from there
  const TetraMesh row =
      test::kuhn_grid({2000, 1, 1}, dvec3(0.0), {2.0, 1e-3, 1e-3}, [](const dvec3&) { return 0; });
  Probe probe(CellComplex::build(row), {air()}, {1e-4, 3.1e-4, 4.7e-4});
  const dvec3 goal{1.9999, 3.1e-4, 4.7e-4};
  probe.move_to(goal);
  EXPECT_EQ(probe.table().limited, 1U);
  EXPECT_LT(probe.proxy().position.x, goal.x);
  EXPECT_GT(probe.proxy().position.x, 0.5);
  while (probe.proxy().position.x < goal.x - 1e-9) {
    const double before = probe.proxy().position.x;
    probe.move_to(goal);
    ASSERT_GT(probe.proxy().position.x, before);
  }
}

}  // namespace
}  // namespace haptic::engine
