#pragma once
// What goes on when an edited scene takes over from the one before it: made off the servo thread, obeyed by
// World::carry_over. The engine knows objects and fingers by index only; who edits knows which became which.

#include <span>
#include <vector>

#include "engine/proxy.h"
#include "engine/scene.h"

namespace haptic::engine {

/// Of one object of the scene after the edit.
struct CarriedObject {
  Index from = kNone;     // the object before it, whose present pose it takes over; kNone: it starts anew
  bool motion = false;    // and velocity, angular momentum and the wrench of the last instant
  bool contacts = false;  // and what each carried HIP holds; false: all HIPs are started against it
};

/// By index of the scene after the edit.
struct CarryMap {
  std::vector<CarriedObject> objects;
  std::vector<Index> fingers;  // the finger before it, whose HIPs go on; kNone: it starts anew
};

/// What can go on, given which object and finger came from which (kNone: from none; an object that was put
/// elsewhere counts as none). An object keeps its motion unless its mass properties changed or it became
/// fixed or loose; it keeps its contacts unless its cells changed, or one of their regions became rigid or is
/// no longer so. A finger goes on if it has the same HIPs on the same device. Not real-time safe.
CarryMap make_carry_map(const Scene& before, const Scene& after, std::span<const Index> object_from,
                        std::span<const Index> finger_from);

}  // namespace haptic::engine
