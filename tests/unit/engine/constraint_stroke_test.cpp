// Random strokes of a million ticks and more, over models with convex and concave edges and corners, faces of
// many sizes and every kind of material. Invariants, asked after every tick:
//   * the proxy never is inside rigid material,
//   * the distance from HIP to proxy never grows within a tick (by more than the tolerance within which a
//   proxy counts as
//     on a face, an edge or a vertex),
//   * inside a cell the force never exceeds what the material yields to,
//   * on a face, friction holds no more than its coefficient times the normal force,
//   * without friction, a proxy at rest is held perpendicular to the face or edge that it is on,
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

void PrintTo(const Model& model, std::ostream* out) { *out << model.name; }
void PrintTo(const Pair& pair, std::ostream* out) { *out << pair.name; }

class Stroke : public ::testing::TestWithParam<std::tuple<Model, Pair>> {};

/// A HIP that wanders, dwells, darts, comes back, and now and then is exactly on, or a hair beside, a vertex,
/// an edge or a face of the model.
class Wanderer {
 public:
  explicit Wanderer(const CellComplex& complex) : complex_(complex) {}

  dvec3 next(int tick) {
    if (tick % 97 == 0) goal_ = 0.16 * dvec3(random(), random(), random());
    if (tick % 389 == 0) return hip_ = goal_;  // a jump across the model
    if (tick % 41 < 3) return hip_ = on_a_feature();
    const double gain = tick % 3 == 0 ? 0.0 : 0.06;  // every third tick it is still
    hip_ += gain * (goal_ - hip_) + (gain > 0.0 ? 2e-4 * dvec3(random(), random(), random()) : dvec3(0.0));
    return hip_;
  }

 private:
  double random() {
    seed_ = seed_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<double>(seed_ >> 11) * 0x1p-53 - 0.5;
  }

  dvec3 on_a_feature() {
    const auto& rims = complex_.rims();
    const FaceRim& rim = rims[static_cast<std::size_t>((random() + 0.5) * static_cast<double>(rims.size()))];
    const dvec3 a = complex_.vertices()[rim.vertices[0]], b = complex_.vertices()[rim.vertices[1]],
                c = complex_.vertices()[rim.vertices[2]];
    const int kind = static_cast<int>((random() + 0.5) * 6.0);
    const dvec3 on = kind < 2 ? a : (kind < 4 ? 0.5 * (a + b) : (a + b + c) / 3.0);
    const double beside = kind % 2 == 0 ? 0.0 : std::pow(10.0, -3.0 - 12.0 * (random() + 0.5));
    return on + beside * dvec3(random(), random(), random());
  }

  const CellComplex& complex_;
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

/// What the materials around the proxy may do to the force at most.
void expect_bounded_force(const Probe& probe, bool was_slipping) {
  const CellComplex& complex = probe.complex();
  const Proxy& proxy = probe.proxy();
  const dvec3 force = probe.force();
  const auto material = [&](Index cell) {
    return cell == kNone ? Material{} : probe.materials()[complex.cells()[cell].region];
  };
  if (proxy.state == ConstraintState::kTet) {
    const Material in = material(proxy.cell);
    if (in.drag == 0.0) {
      ASSERT_LE(glm::length(force), in.yield_force + 1e-8);
    }
  }
  if (proxy.state == ConstraintState::kSur) {
    const Face& face = complex.faces()[proxy.feature];
    const Material a = material(face.cells[0]), b = material(face.cells[1]);
    if (is_rigid(a) == is_rigid(b)) return;
    const Material& solid = is_rigid(a) ? a : b;
    const Material& around = is_rigid(a) ? b : a;
    if (around.drag > 0.0) return;
    const double normal = glm::dot(force, face.plane.normal);
    const double tangential = glm::length(force - normal * face.plane.normal);
    const double mu = was_slipping ? solid.kinetic_friction : solid.static_friction;
    ASSERT_LE(tangential, mu * std::abs(normal) + around.yield_force + 1e-8);
  }
}

/// Outside everything; but the HIP of a cave starts in the hollow.
dvec3 start_of(const Pair& pair) {
  return is_rigid(pair.outside) ? dvec3(-0.013, -0.012, 0.001) : dvec3(0.3, 0.2, 0.1);
}

TEST_P(Stroke, KeepsEveryInvariant) {
  const auto& [model, pair] = GetParam();
  const TetraMesh mesh = model.mesh();
  const bool bare = std::string(model.name) == "bare_box";
  const std::vector<Material> materials =
      bare ? std::vector<Material>{pair.inside} : std::vector<Material>{pair.outside, pair.inside};
  Probe probe(CellComplex::build(mesh), materials, start_of(pair));
  ASSERT_FALSE(probe.proxy().swallowed);

  Wanderer wanderer(probe.complex());
  constexpr int kTicks = 40000;  // times 35 combinations: 1.4 million
  for (int tick = 0; tick < kTicks; ++tick) {
    const dvec3 hip = wanderer.next(tick);
    const double before = glm::distance(hip, probe.proxy().position);
    const bool slipping = probe.proxy().slipping;
    probe.move_to(hip);
    ASSERT_LE(glm::distance(hip, probe.proxy().position), before + 10.0 * probe.complex().tolerance())
        << "tick " << tick;
    ASSERT_TRUE(is_permitted_place(probe)) << "tick " << tick << " in " << name_of(probe.proxy().state);
    expect_bounded_force(probe, slipping);
    if (HasFatalFailure()) FAIL() << "tick " << tick;
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

TEST(StrokeCoverage, StrokesMeetEveryPermittedTransition) {
  // otherwise the strokes above would prove nothing about those that they never make
  TransitionTable::Table met{};
  for (const Model& model : kModels) {
    const bool bare = std::string(model.name) == "bare_box";
    for (const Pair& pair : kPairs) {
      if (bare && is_rigid(pair.outside)) continue;
      const auto materials =
          bare ? std::vector<Material>{pair.inside} : std::vector<Material>{pair.outside, pair.inside};
      Probe probe(CellComplex::build(model.mesh()), materials, start_of(pair));
      Wanderer wanderer(probe.complex());
      for (int tick = 0; tick < 40000; ++tick) probe.move_to(wanderer.next(tick));
      for (std::size_t i = 0; i < met.size(); ++i) {
        for (std::size_t j = 0; j < met.size(); ++j) met[i][j] += probe.table().count[i][j];
      }
    }
  }
  for (int before = 0; before < kConstraintStates; ++before) {
    for (int after = 0; after < kConstraintStates; ++after) {
      const auto from = static_cast<ConstraintState>(before), to = static_cast<ConstraintState>(after);
      EXPECT_EQ(met[static_cast<std::size_t>(before)][static_cast<std::size_t>(after)] > 0,
                is_permitted(from, to))
          << name_of(from) << " -> " << name_of(to);
    }
  }
}

/// All that make sense: a cave needs cells around it.
std::vector<std::tuple<Model, Pair>> combinations() {
  std::vector<std::tuple<Model, Pair>> all;
  for (const Model& model : kModels) {
    for (const Pair& pair : kPairs) {
      if (std::string(model.name) == "bare_box" && is_rigid(pair.outside)) continue;
      all.emplace_back(model, pair);
    }
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(OverModelsAndMaterials, Stroke, ::testing::ValuesIn(combinations()),
                         [](const auto& param) {
                           return std::string(std::get<0>(param.param).name) + "_" +
                                  std::get<1>(param.param).name;
                         });

}  // namespace
}  // namespace haptic::engine
