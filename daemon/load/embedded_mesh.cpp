#include "load/embedded_mesh.h"

#include <array>

#include "load/ranges.h"

namespace haptic::load {
namespace {

constexpr int kAxes = 3;
constexpr int kCorners = 4;

}  // namespace

void embed_meshes(v1::Scene& scene, const engine::Scene& built) {
  for (int i = 0; i < scene.object_size(); ++i) {
    v1::Shape& shape = *scene.mutable_object(i)->mutable_shape();
    if (!shape.has_mesh() || shape.mesh().has_embedded()) continue;
    const engine::CellComplex& cells = *built.objects[static_cast<std::size_t>(i)].cells;
    v1::Shape::Tetrahedra& embedded = *shape.mutable_mesh()->mutable_embedded();
    for (const glm::dvec3& vertex : cells.vertices()) {
      embedded.add_vertex(vertex.x);
      embedded.add_vertex(vertex.y);
      embedded.add_vertex(vertex.z);
    }
    for (const engine::Cell& cell : cells.cells()) {
      for (const engine::Index vertex : cell.vertices) embedded.add_cell(vertex);
      embedded.add_tag(cells.region_tags()[cell.region]);
    }
  }
}

engine::TetraMesh mesh_of(const TextSource& source, const std::string& field,
                          const v1::Shape::Tetrahedra& message, std::size_t most_cells) {
  const int cells = message.tag_size();
  if (cells == 0) source.fail(field + ".tag", "is missing: a mesh needs at least one cell");
  if (static_cast<std::size_t>(cells) > most_cells) {
    source.fail(field + ".tag", "has " + std::to_string(cells) + " cells (permitted: up to " +
                                    std::to_string(most_cells) + ")");
  }
  if (message.cell_size() / kCorners != cells || message.cell_size() % kCorners != 0) {
    source.fail(field + ".cell", "has " + std::to_string(message.cell_size()) + " numbers where " +
                                     std::to_string(cells) + " cells need four each");
  }
  if (message.vertex_size() % kAxes != 0) {
    source.fail(field + ".vertex", "has " + std::to_string(message.vertex_size()) +
                                       " numbers, which are not three for each vertex");
  }
  engine::TetraMesh mesh;
  const int vertices = message.vertex_size() / kAxes;
  mesh.vertices.reserve(static_cast<std::size_t>(vertices));
  for (int i = 0; i < message.vertex_size(); ++i) {
    check_range(source, field + "." + item("vertex", i), message.vertex(i), kCoordinates);
  }
  for (int i = 0; i < vertices; ++i) {
    mesh.vertices.emplace_back(message.vertex(kAxes * i), message.vertex(kAxes * i + 1),
                               message.vertex(kAxes * i + 2));
  }
  mesh.cells.reserve(static_cast<std::size_t>(cells));
  for (int i = 0; i < cells; ++i) {
    std::array<engine::Index, 4>& cell = mesh.cells.emplace_back();
    for (int k = 0; k < kCorners; ++k) {
      const engine::Index vertex = message.cell(kCorners * i + k);
      if (vertex >= static_cast<engine::Index>(vertices)) {
        source.fail(
            field + "." + item("cell", kCorners * i + k),
            "there is no vertex " + std::to_string(vertex) + "; the mesh has " + std::to_string(vertices));
      }
      cell[static_cast<std::size_t>(k)] = vertex;
    }
  }
  mesh.tags.assign(message.tag().begin(), message.tag().end());
  return mesh;
}

}  // namespace haptic::load
