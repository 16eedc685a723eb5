#pragma once
// All that a tick changes, flat and copyable: snapshot, reset, record and replay are copies of this, and two
// runs are equal if their hashes are.

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "engine/body.h"
#include "engine/proxy.h"
#include "engine/scene.h"

namespace haptic::engine {

/// One instant: after step() of tick n, poses, proxies and forces all belong to the time n dt.
struct State {
  std::uint64_t ticks = 0;                   // steps made; the last one was tick `ticks - 1`
  std::vector<BodyState> bodies;             // one for each object; a fixed one never moves
  std::vector<Proxy> proxies;                // [object * hip_count + hip]
  std::vector<glm::dvec3> contact_forces;    // N on the user, world; like proxies
  std::vector<glm::dvec3> hip_positions;     // m, world
  std::vector<glm::dvec3> hip_forces;        // N on the user, world: the sum over objects
  std::vector<Wrench> finger_wrenches;       // on the user, about the device's origin, world
  std::vector<std::uint8_t> finger_started;  // the finger was present in the last step
};

/// The state before tick 0. Not real-time safe.
State initial_state(const Scene& scene);

/// XXH64 of every value, in rows of four words that state.cpp lays out: equal states hash equal on every
/// build. As fast as copying them; real-time safe.
std::uint64_t hash(const State& state) noexcept;

}  // namespace haptic::engine
