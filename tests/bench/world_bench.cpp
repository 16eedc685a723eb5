// The cost of a whole step of the world: the held box of the paper's Fig. 5 (two fingertips of eleven HIPs in
// contact, one body), the same fingers far from it, and the parts that do not depend on contact. Compare
// figures of one run with each other; absolute ones depend on the machine.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/shapes.h"
#include "engine/world.h"

namespace haptic::engine {
namespace {

constexpr double kDt = 1e-3;

std::shared_ptr<const Scene> grasp() {
  Object box;
  box.cells = std::make_shared<CellComplex>(CellComplex::build(box_mesh({0.08, 0.03, 0.03}, 0.02)));
  box.materials = {Material{}, Material{kRigid, 0.0, 1.0, 0.5, 500.0}};
  box.dynamic = true;
  box.dynamics = {mass_properties(*box.cells, box.materials), 0.8, 1e-4};
  box.release_after = 0.6;
  auto scene = std::make_shared<Scene>();
  scene->gravity = {0.0, -0.98, 0.0};
  scene->objects = {box};
  scene->fingers = {{"thumb", "left", 100.0, fingertip_layout(0.008, 0.5, 11, {0.0, 0.0, 1.0}), 0},
                    {"index", "right", 100.0, fingertip_layout(0.008, 0.5, 11, {0.0, 0.0, -1.0}), 0}};
  number_hips(*scene);
  return scene;
}

std::array<FingerPose, 2> fingers_at(double x, double y, double z) {
  return {FingerPose{{{x, y, -z}, {1.0, 0.0, 0.0, 0.0}}, true},
          FingerPose{{{x, y, z}, {1.0, 0.0, 0.0, 0.0}}, true}};
}

void close_fingers(World& world) {
  for (int i = 0; i < 1000; ++i)
    world.step(fingers_at(0.03, 0.0, 0.045 - 0.029 * std::min(1.0, i / 400.0)), kDt);
}

void hold_still(benchmark::State& state) {
  World world(grasp());
  close_fingers(world);
  const auto fingers = fingers_at(0.03, 0.0, 0.016);
  for (auto _ : state) world.step(fingers, kDt);
}
BENCHMARK(hold_still);

/// The held box is carried about, up to 0.2 m/s, and slips a little.
void carry_about(benchmark::State& state) {
  World world(grasp());
  close_fingers(world);
  int tick = 0;
  for (auto _ : state) {
    const double angle = 0.01 * tick++;
    world.step(fingers_at(0.03 + 0.02 * std::sin(angle), 0.02 * (1.0 - std::cos(angle)), 0.016), kDt);
  }
}
BENCHMARK(carry_about);

/// Fingers that move where nothing is, beyond the air around the box.
void far_away(benchmark::State& state) {
  World world(grasp());
  int tick = 0;
  for (auto _ : state) {
    const double angle = 0.01 * tick++;
    world.step(fingers_at(1.0 + 0.02 * std::sin(angle), 0.02 * std::cos(angle), 0.1), kDt);
  }
}
BENCHMARK(far_away);

void hash_state(benchmark::State& state) {
  World world(grasp());
  close_fingers(world);
  for (auto _ : state) benchmark::DoNotOptimize(hash(world.state()));
}
BENCHMARK(hash_state);

void integrate_body(benchmark::State& state) {
  const auto scene = grasp();
  const BodyDynamics& dynamics = scene->objects[0].dynamics;
  BodyState body;
  body.angular_momentum = dynamics.mass.inertia * glm::dvec3{1.0, 5.0, 0.1};
  body.applied.torque = {1e-6, 0.0, 0.0};
  for (auto _ : state) integrate(dynamics, scene->gravity, kDt, body);
}
BENCHMARK(integrate_body);

}  // namespace
}  // namespace haptic::engine
