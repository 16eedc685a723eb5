#pragma once
// What every reader of meshes promises, checked with abort() for the fuzz targets.

#include <cstdlib>
#include <vector>

#include "load/mesh_file.h"

namespace haptic::test {

/// One tag and one place for each cell, every index in range, every vertex used.
inline void expect_sound_mesh(const load::LoadedMesh& loaded) {
  const engine::TetraMesh& mesh = loaded.mesh;
  const bool is_complete = !mesh.cells.empty() && mesh.tags.size() == mesh.cells.size() &&
                           loaded.places.size() == mesh.cells.size();
  if (!is_complete) std::abort();
  std::vector<bool> used(mesh.vertices.size(), false);
  for (const auto& cell : mesh.cells) {
    for (const engine::Index vertex : cell) {
      if (vertex >= mesh.vertices.size()) std::abort();
      used[vertex] = true;
    }
  }
  for (const bool is_used : used) {
    if (!is_used) std::abort();
  }
}

}  // namespace haptic::test
