#pragma once
// Scene + State, and the step that takes one instant to the next. The same step runs in the service, offline
// and in tests; given the same scene, finger poses and dt it gives the same bits.

#include <memory>
#include <span>

#include "engine/carry_map.h"
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
  /// finger that appears later. A body under `release_after` is carried on from no instant before it.
  ///
  /// `fingers` has one pose for each finger of the scene. A pose that cannot be meant (see is_usable) counts
  /// as an absent finger in this tick, so that no input poisons the state. An absent finger's HIPs stay where
  /// they were last, hold nothing and feel nothing.
  ///
  /// With a clock, transitions are timed; those of proxies far outside an object are counted only. Real-time
  /// safe.
  void step(std::span<const FingerPose> fingers, double dt, Clock clock = nullptr) noexcept;

  /// Back to the state before tick 0; counters too. Real-time safe.
  void reset() noexcept;

  /// Goes on from a copied state. False, and nothing is changed, if it is not of this scene (by its sizes).
  /// Real-time safe.
  bool restore(const State& state) noexcept;

  /// Goes on from the last instant of `before`, the world of the scene that this one's was edited from: time,
  /// transitions, and what `map` carries. What starts anew joins at that instant, where its scene puts it and
  /// at rest; HIPs of fingers that go on are started against it, and swallowed if inside rigid material.
  /// False, and nothing is changed, if the map is not of these two worlds. Objects x HIPs of work; real-time
  /// safe.
  bool carry_over(const World& before, const CarryMap& map) noexcept;

  const Scene& scene() const noexcept { return *scene_; }
  const std::shared_ptr<const Scene>& shared_scene() const noexcept { return scene_; }
  const State& state() const noexcept { return state_; }
  const TransitionTable& transitions() const noexcept { return transitions_; }
  void clear_transitions() noexcept { transitions_ = TransitionTable{}; }

  /// Proxy (m, world) of one HIP in one object.
  glm::dvec3 proxy_in_world(std::size_t object, std::size_t hip) const noexcept;

 private:
  bool fits(const World& before, const CarryMap& map) const noexcept;
  void carry_finger(const World& before, const CarryMap& map, std::size_t finger) noexcept;
  void carry_contact(const World& before, const CarryMap& map, std::size_t object, std::size_t finger,
                     std::size_t hip) noexcept;
  void move_bodies(double dt) noexcept;
  void place_hips(std::span<const FingerPose> fingers) noexcept;
  void constrain_hips(std::size_t object, double dt, Clock clock) noexcept;
  void sum_hip_forces() noexcept;
  void sum_forces(std::span<const FingerPose> fingers) noexcept;

  std::shared_ptr<const Scene> scene_;
  State initial_;
  State state_;
  std::vector<std::uint8_t> present_;  // fingers, in this tick
  TransitionTable transitions_;
};

}  // namespace haptic::engine
