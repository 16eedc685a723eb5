// Random strokes of a million ticks and more, over models with convex and concave edges and corners, faces of
// many sizes and every kind of material. Invariants, asked after every tick:
//   * the proxy never is inside rigid material,
//   * the distance from HIP to proxy never grows within a tick,
//   * inside a cell the force never exceeds what the material yields to,
//   * only transitions that Table 1 permits are made, no circle has to be broken and the bound is never met.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

#include "engine/constraint.h"
#include "engine/shapes.h"
#include "tests/support/probe.h"

namespace haptic::engine {
namespace {

using glm::dvec3;
using test::air;
using test::Probe;
using test::rigid;
using test::viscous;
using test::yielding;

struct Model {
  const char* name;
  TetraMesh (*mesh)();
};

TetraMesh letter_l() {
  const std::array<glm::dvec2, 6> outline{
      {{-0.04, -0.04}, {0.04, -0.04}, {0.04, -0.01}, {-0.01, -0.01}, {-0.01, 0.04}, {-0.04, 0.04}}};
  return extrusion_mesh(outline, 0.06, 0.03);
}

const Model kModels[] = {
    {"box",
     [] {
       return box_mesh({0.08, 0.06, 0.05}, 0.02);
     }},
    {"bare_box",
     [] {
       return box_mesh({0.08, 0.06, 0.05}, 0.0);
     }},
    {"sphere_80", [] { return icosphere_mesh(0.04, 1, 0.02); }},
    {"sphere_320", [] { return icosphere_mesh(0.04, 2, 0.02); }},
    {"cylinder", [] { return cylinder_mesh(0.03, 0.06, 12, 0.02); }},
    {"letter_l", letter_l},
};

struct Pair {
  const char* name;
  Material outside, inside;
};

const Pair kPairs[] = {
    {"smooth", air(), rigid()},
    {"rough", air(), rigid(1.0, 0.5)},
    {"cave", rigid(0.4, 0.3), air()},
    {"gel", air(), yielding(0.3)},
    {"mud", viscous(1.5), yielding(0.4, 0.8)},
    {"stone_in_water", viscous(2.0), rigid(3.0, 2.0)},
};

class Stroke : public ::testing::TestWithParam<std::tuple<Model, Pair>> {};

/// A HIP that wanders, dwells, darts and comes back.
class Wanderer {
 public:
  dvec3 next(int tick) {
    if (tick % 97 == 0) goal_ = 0.16 * dvec3(random(), random(), random());
    if (tick % 389 == 0) return hip_ = goal_;        // a jump across the model
    const double gain = tick % 3 == 0 ? 0.0 : 0.06;  // every third tick it is still
    hip_ += gain * (goal_ - hip_) + (gain > 0.0 ? 2e-4 * dvec3(random(), random(), random()) : dvec3(0.0));
    return hip_;
  }

 private:
  double random() {
    seed_ = seed_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<double>(seed_ >> 11) * 0x1p-53 - 0.5;
  }
  std::uint64_t seed_ = 20031;
  dvec3 hip_{0.0, 0.0, 0.07}, goal_{0.0, 0.0, 0.0};
};

/// Whether a proxy may be there: in a cell that is not rigid, or on a feature of one (or of the hull).
bool is_permitted_place(const Probe& probe) {
  const CellComplex& complex = probe.complex();
  const auto permits = [&](Index cell) {
    return cell == kNone || !is_rigid(probe.materials()[complex.cells()[cell].region]);
  };
  const Proxy& proxy = probe.proxy();
  switch (proxy.state) {
    case ConstraintState::kTet:
      return permits(proxy.cell);
    case ConstraintState::kSur: {
      const Face& face = complex.faces()[proxy.feature];
      return permits(face.cells[0]) || permits(face.cells[1]);
    }
    case ConstraintState::kEdg: {
      for (const Index face : complex.faces_of_edge(proxy.feature)) {
        if (permits(complex.faces()[face].cells[0]) || permits(complex.faces()[face].cells[1])) return true;
      }
      return false;
    }
    case ConstraintState::kVer: {
      for (const Index face : complex.faces_of_vertex(proxy.feature)) {
        if (permits(complex.faces()[face].cells[0]) || permits(complex.faces()[face].cells[1])) return true;
      }
      return false;
    }
    case ConstraintState::kOut:
      return true;
  }
  return false;
}

TEST_P(Stroke, KeepsEveryInvariant) {
  const auto& [model, pair] = GetParam();
  const TetraMesh mesh = model.mesh();
  const bool bare = std::string(model.name) == "bare_box";
  if (bare && is_rigid(pair.outside)) GTEST_SKIP() << "has no outside cells";
  const std::vector<Material> materials =
      bare ? std::vector<Material>{pair.inside} : std::vector<Material>{pair.outside, pair.inside};
  // outside everything, but for a cave, whose HIP starts in the hollow
  const dvec3 start = is_rigid(pair.outside) ? dvec3(0.0, -0.02, 0.001) : dvec3(0.3, 0.2, 0.1);
  Probe probe(CellComplex::build(mesh), materials, start);
  ASSERT_FALSE(probe.proxy().swallowed);

  Wanderer wanderer;
  constexpr int kTicks = 40000;  // times 35 combinations: 1.4 million
  for (int tick = 0; tick < kTicks; ++tick) {
    const dvec3 hip = wanderer.next(tick);
    const double before = glm::distance(hip, probe.proxy().position);
    probe.move_to(hip);
    const Proxy& proxy = probe.proxy();
    ASSERT_LE(glm::distance(hip, proxy.position), before + 1e-15) << "tick " << tick;
    ASSERT_TRUE(is_permitted_place(probe)) << "tick " << tick << " in " << name_of(proxy.state);
    if (proxy.state == ConstraintState::kTet) {
      const Material& material = materials[probe.complex().cells()[proxy.cell].region];
      if (material.drag == 0.0) {
        ASSERT_LE(glm::length(probe.force()), material.yield_force + 1e-8) << "tick " << tick;
      }
    }
  }

  const TransitionTable& table = probe.table();
  EXPECT_EQ(table.limited, 0U);
  EXPECT_EQ(table.relocations, 0U);
  for (int before = 0; before < kConstraintStates; ++before) {
    for (int after = 0; after < kConstraintStates; ++after) {
      const auto from = static_cast<ConstraintState>(before), to = static_cast<ConstraintState>(after);
      if (is_permitted(from, to)) continue;
      EXPECT_EQ(table.count[static_cast<std::size_t>(before)][static_cast<std::size_t>(after)], 0U)
          << name_of(from) << " -> " << name_of(to);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(OverModelsAndMaterials, Stroke,
                         ::testing::Combine(::testing::ValuesIn(kModels), ::testing::ValuesIn(kPairs)),
                         [](const auto& param) {
                           return std::string(std::get<0>(param.param).name) + "_" +
                                  std::get<1>(param.param).name;
                         });

}  // namespace
}  // namespace haptic::engine
