#include <gtest/gtest.h>

#include <vector>

#include "engine/body.h"
#include "engine/portable_math.h"
#include "engine/shapes.h"
#include "tests/support/expect_vector.h"

namespace haptic::engine {
namespace {

using test::near;

constexpr Material kWood{kRigid, 0.0, 0.0, 0.0, 500.0};
constexpr Material kLead{kRigid, 0.0, 0.0, 0.0, 11000.0};

MassProperties properties_of(const TetraMesh& mesh, const std::vector<Material>& materials) {
  return mass_properties(CellComplex::build(mesh), materials);
}

// inertia tensor about the centre of gravity, in the object's axes
glm::dmat3 inertia_tensor(const MassProperties& mass) {
  const glm::dmat3 axes = glm::mat3_cast(mass.object_from_gravity_centre.orientation);
  const glm::dmat3 principal{{mass.inertia.x, 0, 0}, {0, mass.inertia.y, 0}, {0, 0, mass.inertia.z}};
  return axes * principal * glm::transpose(axes);
}

void expect_near(const glm::dmat3& actual, const glm::dmat3& expected, double tolerance) {
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(near(actual[i], expected[i], tolerance)) << "column " << i;
}

TetraMesh moved(TetraMesh mesh, const Pose& pose) {
  for (glm::dvec3& v : mesh.vertices) v = pose * v;
  return mesh;
}

TEST(MassProperties, OfABoxAreTheClosedFormInItsOwnAxes) {
  const double a = 0.08;
  const double b = 0.03;
  const double c = 0.05;
  const MassProperties mass = properties_of(box_mesh({a, b, c}, 0.0), {kWood});
  const double m = 500.0 * a * b * c;
  EXPECT_NEAR(mass.mass, m, 1e-15);
  EXPECT_TRUE(near(mass.object_from_gravity_centre.position, {0.0, 0.0, 0.0}, 1e-17));
  EXPECT_EQ(mass.object_from_gravity_centre.orientation, glm::dquat(1.0, 0.0, 0.0, 0.0));
  const glm::dvec3 inertia{b * b + c * c, c * c + a * a, a * a + b * b};
  EXPECT_TRUE(near(mass.inertia, m / 12.0 * inertia, 1e-18));
}

TEST(MassProperties, OfACubeKeepItsAxesThoughAnyWouldDo) {
  const MassProperties mass = properties_of(box_mesh({0.03, 0.03, 0.03}, 0.02), {Material{}, kWood});
  EXPECT_EQ(mass.object_from_gravity_centre.orientation, glm::dquat(1.0, 0.0, 0.0, 0.0));
}

TEST(MassProperties, CountNothingForAir) {
  const MassProperties bare = properties_of(box_mesh({0.08, 0.03, 0.05}, 0.0), {kWood});
  const MassProperties wrapped = properties_of(box_mesh({0.08, 0.03, 0.05}, 0.02), {Material{}, kWood});
  EXPECT_NEAR(wrapped.mass, bare.mass, 1e-16);
  EXPECT_TRUE(near(wrapped.inertia, bare.inertia, 1e-19));
  EXPECT_TRUE(near(wrapped.object_from_gravity_centre.position, {0.0, 0.0, 0.0}, 1e-16));
}

TEST(MassProperties, OfNoDensityAreNone) {
  const MassProperties mass = properties_of(box_mesh({0.08, 0.03, 0.05}, 0.0), {Material{}});
  EXPECT_EQ(mass.mass, 0.0);
  EXPECT_EQ(mass.inertia, glm::dvec3(0.0));
}

// the corner of a box cut off: (0,0,0), (a,0,0), (0,b,0), (0,0,c)
TetraMesh corner(double a, double b, double c) {
  return {{{0, 0, 0}, {a, 0, 0}, {0, b, 0}, {0, 0, c}}, {{0, 1, 2, 3}}, {1}};
}

// Over it x^2 integrates to V a^2 / 10 and x y to V a b / 20, from the corner; from the centre of gravity at
// (a, b, c) / 4 these are less by V a^2 / 16 and V a b / 16.
glm::dmat3 inertia_of_corner(double a, double b, double c, double m) {
  const double square = m * (1.0 / 10.0 - 1.0 / 16.0);
  const double product = m * (1.0 / 20.0 - 1.0 / 16.0);
  return {{square * (b * b + c * c), -product * a * b, -product * a * c},
          {-product * a * b, square * (c * c + a * a), -product * b * c},
          {-product * a * c, -product * b * c, square * (a * a + b * b)}};
}

TEST(MassProperties, OfATetrahedronAreTheClosedForm) {
  const double a = 0.1;
  const double b = 0.07;
  const double c = 0.04;
  const MassProperties mass = properties_of(corner(a, b, c), {kWood});
  EXPECT_NEAR(mass.mass, 500.0 * a * b * c / 6.0, 1e-15);
  EXPECT_TRUE(near(mass.object_from_gravity_centre.position, {a / 4, b / 4, c / 4}, 1e-16));
  expect_near(inertia_tensor(mass), inertia_of_corner(a, b, c, mass.mass), 1e-18);
}

TEST(MassProperties, MoveAndTurnWithTheMesh) {
  const MassProperties still = properties_of(corner(0.1, 0.07, 0.04), {kWood});
  for (const double distance : {0.0, 0.1, 10.0}) {
    const Pose pose{{distance, -2.0 * distance, distance}, rotation_by({0.7, -1.9, 0.4})};
    const MassProperties mass = properties_of(moved(corner(0.1, 0.07, 0.04), pose), {kWood});
    const double rounding = 1e-14 * (1.0 + distance / 0.1);
    EXPECT_NEAR(mass.mass, still.mass, still.mass * rounding);
    EXPECT_TRUE(near(mass.object_from_gravity_centre.position,
                     pose * still.object_from_gravity_centre.position, 0.1 * rounding));
    const glm::dmat3 turn = glm::mat3_cast(pose.orientation);
    expect_near(inertia_tensor(mass), turn * inertia_tensor(still) * glm::transpose(turn),
                still.inertia.x * rounding);
  }
}

TEST(MassProperties, OfTwoDensitiesFollowTheParallelAxes) {
  // two boxes end to end along x, one of lead: each its own inertia plus m d^2 about the common centre
  TetraMesh mesh = box_mesh({0.04, 0.03, 0.02}, 0.0);
  TetraMesh second = moved(mesh, {{0.1, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}});
  const auto shift = static_cast<Index>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), second.vertices.begin(), second.vertices.end());
  mesh.tags.assign(mesh.cells.size(), 1);
  for (auto cell : second.cells) {
    for (Index& vertex : cell) vertex += shift;
    mesh.cells.push_back(cell);
    mesh.tags.push_back(2);
  }
  const MassProperties mass = properties_of(mesh, {kWood, kLead});
  const double wood = 500.0 * 0.04 * 0.03 * 0.02;
  const double lead = 11000.0 * 0.04 * 0.03 * 0.02;
  const double centre = lead * 0.1 / (wood + lead);
  EXPECT_NEAR(mass.mass, wood + lead, 1e-15);
  EXPECT_TRUE(near(mass.object_from_gravity_centre.position, {centre, 0.0, 0.0}, 1e-15));
  const double steiner = wood * centre * centre + lead * (0.1 - centre) * (0.1 - centre);
  const glm::dvec3 own =
      (wood + lead) / 12.0 *
      glm::dvec3{0.03 * 0.03 + 0.02 * 0.02, 0.02 * 0.02 + 0.04 * 0.04, 0.04 * 0.04 + 0.03 * 0.03};
  EXPECT_TRUE(near(mass.inertia, own + glm::dvec3{0.0, steiner, steiner}, 1e-17));
}

}  // namespace
}  // namespace haptic::engine
