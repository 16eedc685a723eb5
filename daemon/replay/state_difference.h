#pragma once
// Where a state and what was recorded of it part: for a person who looks for the reason.

#include <string>

#include "engine/world.h"
#include "haptic/v1/telemetry.pb.h"

namespace haptic::replay {

/// The first of the frame's objects and HIPs that is not, to the bit, as in `world`: "object box: position.x
/// is 0.5, recorded 0.25". Empty if all that the frame tells of them is the same.
std::string find_difference(const v1::Frame& recorded, const engine::World& world);

}  // namespace haptic::replay
