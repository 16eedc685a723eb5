// What the last stage costs for each device in each tick, and what lies before it: the workspace and the
// filter of velocity.

#include <benchmark/benchmark.h>

#include <cmath>

#include "safety/force_guard.h"
#include "servo/motion_filter.h"
#include "servo/workspace.h"

namespace haptic {
namespace {

constexpr double kDt = 0.001;

/// A hand that circles in a wall, so that nothing is zero and nothing trips.
safety::GuardInput input_of(std::uint64_t tick) {
  const double angle = 0.01 * static_cast<double>(tick % 628);
  const glm::dvec3 place{0.02 * std::cos(angle), 0.02 * std::sin(angle), 0.0};
  return {.tick = tick,
          .present = true,
          .sample_time = static_cast<std::int64_t>(tick) * 1'000'000,
          .position = place,
          .place = place,
          .velocity = {-0.2 * std::sin(angle), 0.2 * std::cos(angle), 0.0},
          .force = {0.0, 0.0, 2.0}};
}

/// The sine and cosine of the input alone, to be taken off.
void input(benchmark::State& state) {
  std::uint64_t tick = 0;
  for (auto _ : state) benchmark::DoNotOptimize(input_of(tick++));
}
BENCHMARK(input);

/// With every limit on.
void guard(benchmark::State& state) {
  safety::GuardLimits limits;
  limits.max_mean_force = 3.0;
  limits.max_still = 1.0;
  limits.travel = {glm::dvec3(-0.1), glm::dvec3(0.1)};
  safety::ForceGuard guard(limits);
  guard.arm_at_once();
  std::uint64_t tick = 0;
  for (auto _ : state) benchmark::DoNotOptimize(guard.guard(input_of(tick++), kDt));
  if (guard.fault().kind != safety::FaultKind::kNone) state.SkipWithError("a fault was latched");
}
BENCHMARK(guard);

void workspace(benchmark::State& state) {
  servo::Workspace workspace(
      {.world_from_base = {glm::dvec3(0.1), {0.5, 0.5, 0.5, 0.5}}, .scale = 2.0, .clutch_button = 1});
  std::uint64_t tick = 0;
  for (auto _ : state) {
    const safety::GuardInput hand = input_of(tick++);
    benchmark::DoNotOptimize(
        workspace.to_world({.position = hand.position, .velocity = hand.velocity, .buttons = 0}));
    benchmark::DoNotOptimize(workspace.to_base(hand.position));
  }
}
BENCHMARK(workspace);

/// Slow motion, so that the window is as long as it may be: at so many kHz.
void adaptive_window(benchmark::State& state) {
  const auto kilohertz = state.range(0);
  servo::MotionFilter filter({.kind = servo::MotionFilterKind::kAdaptiveWindow},
                             1e3 * static_cast<double>(kilohertz));
  std::int64_t tick = 0;
  for (auto _ : state) {
    ++tick;
    const double x = 1e-6 * static_cast<double>(tick);
    benchmark::DoNotOptimize(filter.take({.time = tick * 1'000'000 / kilohertz, .position = {x, x, x}}));
  }
}
BENCHMARK(adaptive_window)->Arg(1)->Arg(8);

}  // namespace
}  // namespace haptic
