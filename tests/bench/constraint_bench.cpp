// The cost of the constraint: each transition (the paper's Table 2), tracing spheres of growing size, and
// many HIPs in contact. Compare figures of one run with each other; absolute ones depend on the machine.

#include <benchmark/benchmark.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "engine/constraint.h"
#include "engine/constraint/tick.h"
#include "engine/shapes.h"

namespace haptic::engine {
namespace {

using glm::dvec3;

constexpr Material kAir{};
constexpr Material kRough{kRigid, 0.0, 1.0, 0.5, 1000.0};
constexpr Material kSmooth{kRigid, 0.0, 0.0, 0.0, 1000.0};
constexpr double kStiffness = 100.0;
constexpr double kTick = 1e-3;

class Random {
 public:
  double next() {
    seed_ = seed_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<double>(seed_ >> 11) * 0x1p-53 - 0.5;
  }
  dvec3 vector() { return {next(), next(), next()}; }

 private:
  std::uint64_t seed_ = 7;
};

/// Twelve cells around one edge, as the paper supposes; nine are rigid, so that the edge is a concave one.
TetraMesh edge_of_twelve() {
  TetraMesh mesh;
  mesh.vertices = {{0.0, 0.0, -0.02}, {0.0, 0.0, 0.02}};
  for (Index i = 0; i < 12; ++i) {
    const double angle = std::numbers::pi / 6.0 * i;
    mesh.vertices.push_back({0.02 * std::cos(angle), 0.02 * std::sin(angle), 0.0});
    mesh.cells.push_back({0, 2 + i, 2 + (i + 1) % 12, 1});
    mesh.tags.push_back(i >= 3 ? 1 : 0);
  }
  return mesh;
}

/// Twenty cells around one vertex: an icosahedron coned to its centre; three of four rigid.
TetraMesh vertex_of_twenty() {
  TetraMesh mesh = icosphere_mesh(0.02, 0, 0.0);
  for (std::size_t i = 0; i < mesh.tags.size(); ++i) mesh.tags[i] = i % 4 == 0 ? 0 : 1;
  return mesh;
}

/// A box of twelve boundary triangles with nothing around it.
TetraMesh outside_of_twelve() {
  TetraMesh mesh = box_mesh({0.03, 0.03, 0.03}, 0.0);
  for (std::int32_t& tag : mesh.tags) tag = 1;
  mesh.tags.front() = 0;
  return mesh;
}

/// A proxy before a transition, and the HIP that caused it.
struct Example {
  Proxy proxy;
  dvec3 hip;
};

/// Transitions of one kind that random strokes over a model met.
std::vector<Example> examples_of(const CellComplex& complex, std::span<const Material> materials,
                                 ConstraintState before, ConstraintState after) {
  std::vector<Example> examples;
  Random random;
  for (int stroke = 0; stroke < 400 && examples.size() < 256; ++stroke) {
    Proxy proxy;
    dvec3 hip = 0.08 * random.vector();
    start_proxy({complex, materials}, hip, proxy);
    if (proxy.swallowed) continue;
    for (int i = 0; i < 400 && examples.size() < 256; ++i) {
      hip += 0.004 * random.vector() - 0.02 * hip;
      // vertices are rarely met by chance
      if (i % 7 == 0) {
        const auto vertices = complex.vertices();
        const double pick = (random.next() + 0.5) * static_cast<double>(vertices.size());
        hip = 1.05 * vertices[static_cast<std::size_t>(pick)] + 1e-4 * random.vector();
      }
      Tick tick{complex, materials, {hip, kStiffness, complex.tolerance(), kTick, proxy.slipping}};
      for (int guard = 0; guard < 50; ++guard) {
        const Proxy was = proxy;
        const bool settled = step(tick, proxy);
        if (was.state == before && proxy.state == after) examples.push_back({was, hip});
        if (settled ||
            (was.state == proxy.state && was.feature == proxy.feature && was.position == proxy.position))
          break;
      }
    }
  }
  return examples;
}

void transition(benchmark::State& state, TetraMesh (*mesh)(), ConstraintState before, ConstraintState after) {
  const CellComplex complex = CellComplex::build(mesh());
  const std::vector<Material> materials{kAir, kRough};
  const std::vector<Example> examples = examples_of(complex, materials, before, after);
  if (examples.empty()) {
    state.SkipWithError("no stroke met this transition");
    return;
  }
  std::size_t next = 0;
  for (auto _ : state) {
    const Example& example = examples[next];
    next = next + 1 < examples.size() ? next + 1 : 0;
    Proxy proxy = example.proxy;
    Tick tick{complex, materials, {example.hip, kStiffness, complex.tolerance(), kTick, proxy.slipping}};
    benchmark::DoNotOptimize(step(tick, proxy));
    benchmark::DoNotOptimize(proxy);
  }
}

void register_transitions() {
  using enum ConstraintState;
  const struct {
    ConstraintState before, after;
    TetraMesh (*mesh)();
  } rows[] = {
      {kTet, kTet, edge_of_twelve},   {kTet, kSur, edge_of_twelve},    {kSur, kTet, edge_of_twelve},
      {kSur, kSur, edge_of_twelve},   {kSur, kEdg, edge_of_twelve},    {kSur, kOut, outside_of_twelve},
      {kEdg, kTet, edge_of_twelve},   {kEdg, kSur, edge_of_twelve},    {kEdg, kEdg, edge_of_twelve},
      {kEdg, kVer, edge_of_twelve},   {kEdg, kOut, edge_of_twelve},    {kVer, kTet, vertex_of_twenty},
      {kVer, kSur, vertex_of_twenty}, {kVer, kEdg, vertex_of_twenty},  {kVer, kVer, vertex_of_twenty},
      {kVer, kOut, edge_of_twelve},   {kOut, kSur, outside_of_twelve}, {kOut, kOut, outside_of_twelve},
  };
  for (const auto& row : rows) {
    const std::string name = std::string("transition/") + name_of(row.before) + "_" + name_of(row.after);
    benchmark::RegisterBenchmark(name.c_str(), transition, row.mesh, row.before, row.after);
  }
}

/// Points 2 mm under the surface of a 50 mm sphere along a great circle that meets no symmetry of the
/// icosahedron, 0.2 mm apart: 0.2 m/s at 1 kHz.
std::vector<dvec3> trace_path(double radius) {
  const dvec3 u = glm::normalize(dvec3(1.0, 0.31, -0.17));
  const dvec3 w = glm::normalize(glm::cross(u, dvec3(0.23, 1.0, 0.41)));
  const double depth = radius - 0.002;
  const auto points = static_cast<std::size_t>(2.0 * std::numbers::pi * depth / 0.0002);
  std::vector<dvec3> path(points);
  for (std::size_t i = 0; i < points; ++i) {
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(points);
    path[i] = depth * (std::cos(angle) * u + std::sin(angle) * w);
  }
  return path;
}

/// `hips` HIPs on the same circle, one tick of all of them an iteration; items are HIPs.
void trace_sphere(benchmark::State& state, const Material& solid, double outset) {
  const auto subdivisions = static_cast<int>(state.range(0));
  const auto hips = static_cast<std::size_t>(state.range(1));
  const double radius = 0.05;
  const CellComplex complex = CellComplex::build(icosphere_mesh(radius, subdivisions, 0.02));
  const std::vector<Material> materials{kAir, solid};
  const std::vector<dvec3> path = trace_path(radius + outset);
  std::vector<Proxy> proxies(hips);
  std::vector<std::size_t> places(hips);
  TransitionTable table;
  for (std::size_t i = 0; i < hips; ++i) {
    places[i] = i * path.size() / hips;
    start_proxy({complex, materials}, 1.1 * path[places[i]], proxies[i]);
    constrain({complex, materials}, path[places[i]], kStiffness, kTick, proxies[i], table);
  }
  for (auto _ : state) {
    for (std::size_t i = 0; i < hips; ++i) {
      places[i] = places[i] + 1 < path.size() ? places[i] + 1 : 0;
      constrain({complex, materials}, path[places[i]], kStiffness, kTick, proxies[i], table);
    }
  }
  state.SetItemsProcessed(state.iterations() * state.range(1));
  state.counters["ns_per_hip"] =
      benchmark::Counter(static_cast<double>(state.iterations() * state.range(1)) * 1e-9,
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  state.counters["cells"] = static_cast<double>(complex.cells().size());
}

void trace_smooth(benchmark::State& state) { trace_sphere(state, kSmooth, 0.0); }
void trace_rough(benchmark::State& state) { trace_sphere(state, kRough, 0.0); }
void trace_in_air(benchmark::State& state) { trace_sphere(state, kSmooth, 0.005); }

void sizes(benchmark::internal::Benchmark* bench) {
  for (int subdivisions = 1; subdivisions <= 7; ++subdivisions) bench->Args({subdivisions, 22});
}

BENCHMARK(trace_smooth)->Apply(sizes)->ArgNames({"subdivisions", "hips"});
BENCHMARK(trace_rough)->Apply(sizes)->ArgNames({"subdivisions", "hips"});
BENCHMARK(trace_in_air)->Apply(sizes)->ArgNames({"subdivisions", "hips"});
BENCHMARK(trace_rough)
    ->Args({2, 1})
    ->Args({2, 22})
    ->Args({2, 1000})
    ->Args({2, 10000})
    ->ArgNames({"subdivisions", "hips"})
    ->Name("hips_in_contact");

const bool kRegistered = (register_transitions(), true);

}  // namespace
}  // namespace haptic::engine
