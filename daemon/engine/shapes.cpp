#include "engine/shapes.h"

#include <algorithm>
#include <array>

#include "engine/cell_builder.h"

namespace haptic::engine {
namespace {

/// Corners of the six faces of a box whose corner i has bit 0 of i in x, bit 1 in y and bit 2 in z.
constexpr std::array<PieceFace, 6> kBoxFaces{
    {{0, 2, 6, 4}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 5, 7, 6}}};

void add_corners(TetraMesh& mesh, const glm::dvec3& half) {
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.emplace_back((i & 1) != 0 ? half.x : -half.x, (i & 2) != 0 ? half.y : -half.y,
                               (i & 4) != 0 ? half.z : -half.z);
  }
}

}  // namespace

TetraMesh box_mesh(const glm::dvec3& size, double air_margin) {
  const std::array<Length, 3> lengths{{{"size.x", size.x}, {"size.y", size.y}, {"size.z", size.z}}};
  require_lengths(lengths);
  require_margin(air_margin, std::max({size.x, size.y, size.z}));

  TetraMesh mesh;
  add_corners(mesh, 0.5 * size);
  add_piece(mesh, kBoxFaces, kInside);
  if (air_margin == 0.0) return mesh;

  // one frustum on each face of the box
  add_corners(mesh, 0.5 * size + air_margin);
  for (const PieceFace& face : kBoxFaces) {
    PieceFace outer;
    for (std::size_t k = 0; k < 4; ++k) outer[k] = face[k] + 8;
    std::array<PieceFace, 6> frustum{face, outer};
    for (std::size_t k = 0; k < 4; ++k) {
      frustum[2 + k] = {face[k], face[(k + 1) % 4], outer[(k + 1) % 4], outer[k]};
    }
    add_piece(mesh, frustum, kOutside);
  }
  return mesh;
}

}  // namespace haptic::engine
