#pragma once
// The state of a world as a message and back, every number to the bit. Not real-time safe.

#include "engine/scene.h"
#include "engine/state.h"
#include "haptic/v1/state.pb.h"

namespace haptic::load {

/// Sets what belongs to `state`, and its hash; the rest of the message is the caller's.
void write_state(const engine::State& state, v1::WorldState& message);

/// The state in the message, from which a world of `scene` can go on. Throws LoadError with the field if it
/// is not of this scene by its sizes, if a number is not finite, or if a proxy is nowhere in its object.
engine::State read_state(const v1::WorldState& message, const engine::Scene& scene);

}  // namespace haptic::load
