// The same solid, cut into cells in different ways and numbered differently, feels the same: cells are a way
// to compute, not something that a hand could notice.

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <string>

#include "engine/constraint.h"
#include "engine/shapes.h"
#include "tests/support/expect_vector.h"
#include "tests/support/meshes.h"
#include "tests/support/probe.h"

namespace haptic::engine {
namespace {

using glm::dvec3;
using test::near;
using test::Probe;

/// An 80 mm cube in 40 mm of air as `cuts` cubes to an edge of 40 mm, six cells each.
TetraMesh cube_mesh(int cuts) {
  return test::kuhn_grid({4 * cuts, 4 * cuts, 4 * cuts}, dvec3(-0.08), dvec3(0.08), [](const dvec3& p) {
    return std::abs(p.x) < 0.04 && std::abs(p.y) < 0.04 && std::abs(p.z) < 0.04 ? 1 : 0;
  });
}

/// Round the solid, over its edges and corners, touching and leaving: no place twice, none on a symmetry.
dvec3 stroke(int tick) {
  const double t = 1e-3 * tick;
  return {0.047 * std::sin(1.71 * t + 0.2), 0.045 * std::sin(2.33 * t + 1.1), 0.046 * std::cos(1.37 * t)};
}

/// Into the notch of the L, along its edge, into its end and out again.
dvec3 into_the_notch(int tick) {
  const double t = 1e-3 * tick;
  return {0.1 + 0.03 * std::sin(1.9 * t), 0.1 + 0.03 * std::cos(2.6 * t + 0.7),
          0.05 + 0.055 * std::sin(0.83 * t)};
}

void expect_same_forces(Probe& one, Probe& other, dvec3 (*path)(int tick)) {
  int held = 0;
  for (int tick = 0; tick < 20000; ++tick) {
    one.move_to(path(tick));
    other.move_to(path(tick));
    ASSERT_TRUE(near(one.proxy().position, other.proxy().position, 1e-9)) << "tick " << tick;
    held += glm::length(one.force()) > 1e-3 ? 1 : 0;
  }
  EXPECT_GT(held, 2000) << "the stroke hardly touched";
}

class Cutting : public ::testing::TestWithParam<Material> {};

TEST_P(Cutting, ConvexSolidFeelsTheSameCutCoarselyOrFinely) {
  Probe coarse(CellComplex::build(cube_mesh(1)), {test::air(), GetParam()}, stroke(0));
  Probe fine(CellComplex::build(cube_mesh(3)), {test::air(), GetParam()}, stroke(0));
  expect_same_forces(coarse, fine, stroke);
}

TEST_P(Cutting, ShapeAndGridOfTheSameBoxFeelTheSame) {
  Probe shape(CellComplex::build(box_mesh(dvec3(0.08), 0.04)), {test::air(), GetParam()}, stroke(0));
  Probe grid(CellComplex::build(cube_mesh(1)), {test::air(), GetParam()}, stroke(0));
  expect_same_forces(shape, grid, stroke);
}

TEST_P(Cutting, NumberingOfVerticesAndCellsDoesNotMatter) {
  const TetraMesh mesh = cube_mesh(2);
  Probe ordered(CellComplex::build(mesh), {test::air(), GetParam()}, stroke(0));
  Probe shuffled(CellComplex::build(test::shuffled(mesh, 5)), {test::air(), GetParam()}, stroke(0));
  expect_same_forces(ordered, shuffled, stroke);
}

TEST_P(Cutting, ConcaveSolidFeelsTheSameCutCoarselyOrFinely) {
  Probe coarse(CellComplex::build(test::l_block(1)), {test::air(), GetParam()}, {0.15, 0.15, 0.05});
  Probe fine(CellComplex::build(test::l_block(2)), {test::air(), GetParam()}, {0.15, 0.15, 0.05});
  expect_same_forces(coarse, fine, into_the_notch);
}

std::string name_of_material(const ::testing::TestParamInfo<Material>& info) {
  if (!is_rigid(info.param)) return "yielding";
  return info.param.static_friction > 0.0 ? "rough" : "smooth";
}

INSTANTIATE_TEST_SUITE_P(OfEachMaterial, Cutting,
                         ::testing::Values(test::rigid(), test::rigid(1.0, 0.5), test::yielding(0.2)),
                         name_of_material);

}  // namespace
}  // namespace haptic::engine
