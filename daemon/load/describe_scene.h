#pragma once
// What clients and recordings are told of a scene that was built.

#include <vector>

#include "engine/scene.h"
#include "haptic/v1/control.pb.h"
#include "load/scene_file.h"

namespace haptic::load {

/// All but the revision.
v1::SceneDescription describe(const LoadedScene& loaded);

/// The faces that a finger can tell from what is around them, as indices of CellComplex::faces() in ascending
/// order: where the material changes, and on the hull where it is not free.
std::vector<engine::Index> surface_faces(const engine::Object& object);

}  // namespace haptic::load
