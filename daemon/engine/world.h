#pragma once
// Scene + State, and the step that takes one instant to the next. The same step runs in the service, offline
// and in tests; given the same scene, finger poses and dt it gives the same bits.

#include <memory>
#include <span>

#include "engine/constraint.h"
#include "engine/finger.h"
#include "engine/scene.h"
#include "engine/state.h"

namespace haptic::engine {

class World {
 public:
  /// Reserves everything that stepping needs. Not real-time safe.
  explicit World(std::shared_ptr<const Scene> scene);

  /// One tick of dt seconds. Bodies first move on from the last instant under the wrenches found there; then
  /// every HIP is placed, its proxies are constrained in the objects' present poses, and forces are summed:
  /// so all of state() belongs to one instant. Tick 0 moves nothing and puts each proxy at its HIP, as for a
  /// finger that appears later. `fingers` has one pose for each finger of the scene. With a clock,
  /// transitions are timed. Real-time safe.
  void step(std::span<const FingerPose> fingers, double dt, Clock clock = nullptr) noexcept;

  /// Back to the state before tick 0; counters too. Real-time safe.
  void reset() noexcept;

  const Scene& scene() const noexcept { return *scene_; }
  const State& state() const noexcept { return state_; }
  const TransitionTable& transitions() const noexcept { return transitions_; }

  /// Proxy (m, world) of one HIP in one object.
  glm::dvec3 proxy_in_world(std::size_t object, std::size_t hip) const noexcept;

 private:
  void move_bodies(double dt) noexcept;
  void place_hips(std::span<const FingerPose> fingers) noexcept;
  void constrain_hips(std::span<const FingerPose> fingers, double dt, Clock clock) noexcept;
  void sum_forces(std::span<const FingerPose> fingers) noexcept;

  std::shared_ptr<const Scene> scene_;
  State initial_;
  State state_;
  TransitionTable transitions_;
};

}  // namespace haptic::engine
