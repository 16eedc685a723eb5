#include "engine/cell_builder.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace haptic::engine {

void add_cell(TetraMesh& mesh, std::array<Index, 4> vertices, std::int32_t tag) {
  const glm::dvec3& origin = mesh.vertices[vertices[0]];
  const auto from_origin = [&](std::size_t i) { return mesh.vertices[vertices[i]] - origin; };
  if (glm::dot(from_origin(1), glm::cross(from_origin(2), from_origin(3))) < 0.0) {
    std::swap(vertices[2], vertices[3]);
  }
  mesh.cells.push_back(vertices);
  mesh.tags.push_back(tag);
}

void add_piece(TetraMesh& mesh, std::span<const PieceFace> faces, std::int32_t tag) {
  Index apex = kNone;
  for (const PieceFace& face : faces) apex = std::min(apex, *std::min_element(face.begin(), face.end()));
  for (PieceFace face : faces) {
    if (std::find(face.begin(), face.end(), apex) != face.end()) continue;
    if (face[3] == kNone) {
      add_cell(mesh, {apex, face[0], face[1], face[2]}, tag);
    } else {
      std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
      add_cell(mesh, {apex, face[0], face[1], face[2]}, tag);
      add_cell(mesh, {apex, face[0], face[2], face[3]}, tag);
    }
  }
}

void add_prism(TetraMesh& mesh, const std::array<Index, 3>& bottom, const std::array<Index, 3>& top,
               std::int32_t tag) {
  const std::array<PieceFace, 5> faces{{{bottom[0], bottom[1], bottom[2], kNone},
                                        {top[0], top[1], top[2], kNone},
                                        {bottom[0], bottom[1], top[1], top[0]},
                                        {bottom[1], bottom[2], top[2], top[1]},
                                        {bottom[2], bottom[0], top[0], top[2]}}};
  add_piece(mesh, faces, tag);
}

void require_lengths(std::span<const Length> lengths) {
  double largest = 0.0;
  for (const Length& length : lengths) {
    require(std::isfinite(length.value) && length.value > 0.0, length.name, " is ", length.value,
            "; it must be finite and positive");
    largest = std::max(largest, length.value);
  }
  for (const Length& length : lengths) {
    require(length.value >= kSmallestRatio * largest, length.name, " is ", length.value,
            " m; beside a length of ", largest, " m it must be at least ", kSmallestRatio * largest, " m");
  }
}

void require_margin(double air_margin, double size) {
  if (air_margin == 0.0) return;
  require(std::isfinite(air_margin) && air_margin > 0.0, "air_margin is ", air_margin,
          "; it must be finite, and positive or 0");
  const std::array<Length, 2> lengths{{{"air_margin", air_margin}, {"the shape's size", size}}};
  require_lengths(lengths);
}

}  // namespace haptic::engine
