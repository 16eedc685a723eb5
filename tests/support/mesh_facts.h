#pragma once
// What tests ask about a mesh as a whole.

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>

#include "engine/cell_complex.h"
#include "engine/shapes.h"

namespace haptic::test {

struct MeshFacts {
  double inside_volume = 0.0;   // m^3
  double outside_volume = 0.0;  // m^3
  std::size_t inside_cells = 0;
  std::size_t outside_cells = 0;
  std::size_t surface_triangles = 0;  // between an inside cell and an outside cell or nothing
  std::size_t inside_on_hull = 0;     // of these, those to nothing
  std::size_t most_at_vertex = 0;     // cells
  std::size_t most_at_edge = 0;       // cells
  double least_altitude = 0.0;        // of any cell, as a part of the extent
};

/// Facts of a mesh whose regions are tagged kInside and kOutside, or have one of the two only.
inline MeshFacts facts_of(const engine::CellComplex& complex) {
  MeshFacts facts;
  const auto is_inside = [&](engine::Index cell) {
    return complex.region_tags()[complex.cells()[cell].region] == engine::kInside;
  };
  double least = std::numeric_limits<double>::infinity();
  for (engine::Index c = 0; c < complex.cells().size(); ++c) {
    const engine::Cell& cell = complex.cells()[c];
    const auto at = [&](std::size_t i) { return complex.vertices()[cell.vertices[i]]; };
    const double volume = glm::dot(at(1) - at(0), glm::cross(at(2) - at(0), at(3) - at(0))) / 6.0;
    (is_inside(c) ? facts.inside_volume : facts.outside_volume) += volume;
    (is_inside(c) ? facts.inside_cells : facts.outside_cells) += 1;
    for (int i = 0; i < 4; ++i) least = std::min(least, cell.side(i, at(static_cast<std::size_t>(i))));
  }
  facts.least_altitude = least / glm::distance(complex.bounds().low, complex.bounds().high);
  for (const engine::Face& face : complex.faces()) {
    const bool first = is_inside(face.cells[0]);
    const bool second = face.cells[1] != engine::kNone && is_inside(face.cells[1]);
    if (first != second) ++facts.surface_triangles;
    if (first && face.cells[1] == engine::kNone) ++facts.inside_on_hull;
  }
  for (engine::Index v = 0; v < complex.vertices().size(); ++v) {
    facts.most_at_vertex = std::max(facts.most_at_vertex, complex.cells_of_vertex(v).size());
  }
  for (engine::Index e = 0; e < complex.edges().size(); ++e) {
    facts.most_at_edge = std::max(facts.most_at_edge, complex.cells_of_edge(e).size());
  }
  return facts;
}

}  // namespace haptic::test
