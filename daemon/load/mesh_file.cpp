#include "load/mesh_file.h"

#include <glm/geometric.hpp>

#include "load/read_file.h"

namespace haptic::load {

using engine::Index;
using engine::kNone;

namespace {

// below this fraction of its edges' product a volume is rounding: CellComplex::build will call the cell flat
constexpr double kFlatVolume = 1e-13;

int orientation(const engine::TetraMesh& mesh, const std::array<Index, 4>& cell) {
  const glm::dvec3& origin = mesh.vertices[cell[0]];
  const glm::dvec3 a = mesh.vertices[cell[1]] - origin;
  const glm::dvec3 b = mesh.vertices[cell[2]] - origin;
  const glm::dvec3 c = mesh.vertices[cell[3]] - origin;
  const double volume = glm::dot(a, glm::cross(b, c));
  const double flat = kFlatVolume * glm::length(a) * glm::length(b) * glm::length(c);
  return volume > flat ? 1 : volume < -flat ? -1 : 0;
}

void orient(LoadedMesh& loaded) {
  engine::TetraMesh& mesh = loaded.mesh;
  int sense = 0;
  for (std::size_t i = 0; i < mesh.cells.size(); ++i) {
    const int own = orientation(mesh, mesh.cells[i]);
    if (own == 0) continue;
    if (sense == 0) sense = own;
    if (own != sense) {
      fail_at_cell(loaded, static_cast<Index>(i),
                   std::string("is the first cell with ") + (own < 0 ? "negative" : "positive") +
                       " volume: all cells before it are the other way round");
    }
  }
  if (sense >= 0) return;
  for (auto& cell : mesh.cells) std::swap(cell[2], cell[3]);
}

void drop_unused_vertices(engine::TetraMesh& mesh) {
  std::vector<Index> renumbered(mesh.vertices.size(), kNone);
  for (const auto& cell : mesh.cells) {
    for (const Index vertex : cell) renumbered[vertex] = 0;
  }
  Index used = 0;
  for (std::size_t i = 0; i < renumbered.size(); ++i) {
    if (renumbered[i] == kNone) continue;
    renumbered[i] = used;
    mesh.vertices[used++] = mesh.vertices[i];
  }
  if (used == mesh.vertices.size()) return;
  mesh.vertices.resize(used);
  for (auto& cell : mesh.cells) {
    for (Index& vertex : cell) vertex = renumbered[vertex];
  }
}

}  // namespace

void fail_at_cell(const LoadedMesh& mesh, Index cell, const std::string& message) {
  const std::string name = "cell " + std::to_string(cell) + " (counted from 0) ";
  if (mesh.binary) {
    throw LoadError({mesh.file, 0, 0, ""},
                    "byte " + std::to_string(mesh.places[cell]) + ": " + name + message);
  }
  throw LoadError({mesh.file, static_cast<std::uint32_t>(mesh.places[cell]), 0, ""}, name + message);
}

void finish_mesh(LoadedMesh& loaded) {
  if (loaded.mesh.cells.empty()) {
    throw LoadError({loaded.file, 0, 0, ""},
                    "has no first-order tetrahedra" + (loaded.skipped_cells == 0
                                                           ? std::string()
                                                           : ", but " + std::to_string(loaded.skipped_cells) +
                                                                 " volume elements of other types"));
  }
  orient(loaded);
  drop_unused_vertices(loaded.mesh);
}

LoadedMesh read_mesh(const std::filesystem::path& file) {
  if (file.extension() == ".ele") {
    std::filesystem::path nodes = file;
    nodes.replace_extension(".node");
    return parse_tetgen(read_file(nodes, kMaxMeshBytes), nodes.string(), read_file(file, kMaxMeshBytes),
                        file.string());
  }
  if (file.extension() == ".msh") return parse_gmsh(read_file(file, kMaxMeshBytes), file.string());
  throw LoadError({file.string(), 0, 0, ""}, "is not a mesh by its name (permitted: .ele, .msh)");
}

}  // namespace haptic::load
