#pragma once
// Meshes within the message of a scene, so that a scene that is sent or recorded needs no file beside it.
// Cells and vertices keep their numbers: what is built of the message is, to the bit, what was built of the
// file. Not real-time safe.

#include <cstddef>
#include <string>

#include "engine/cell_complex.h"
#include "engine/scene.h"
#include "haptic/v1/scene.pb.h"
#include "load/text_message.h"

namespace haptic::load {

/// Puts into every object of `scene` whose shape names a mesh file the cells that were built of it: `built`
/// has the same objects in the same order.
void embed_meshes(v1::Scene& scene, const engine::Scene& built);

/// The mesh in the message (m). Throws LoadError if its lists do not fit each other, an index is none, a
/// coordinate is too large, or it has no cells or more than `most_cells`. `field` is where it stands.
engine::TetraMesh mesh_of(const TextSource& source, const std::string& field,
                          const v1::Shape::Tetrahedra& message, std::size_t most_cells);

}  // namespace haptic::load
