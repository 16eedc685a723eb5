#pragma once
// What joins the cells of a mesh: which share a face, and which an edge. Everything is found by sorting, in
// near-linear time, and depends on the order of the mesh only.

#include "engine/cell_complex.h"

namespace haptic::engine {

/// Vertices of the face opposite vertex i of a positive cell, counter-clockwise seen from inside it.
inline constexpr std::array<std::array<std::uint8_t, 3>, 4> kFaceCorners{{
    {1, 3, 2},
    {0, 2, 3},
    {0, 3, 1},
    {0, 1, 2},
}};

/// The six edges of a cell as pairs of its vertices; the planes that contain edge e are those opposite the
/// ends of edge 5 - e.
inline constexpr std::array<std::array<std::uint8_t, 2>, 6> kEdgeEnds{{
    {0, 1},
    {0, 2},
    {0, 3},
    {1, 2},
    {1, 3},
    {2, 3},
}};

/// Fills a Star: `visit_all(visit)` must call visit(feature, item) for every pair, in the same order each
/// time.
template <class T, class VisitAll>
Star<T> make_star(std::size_t features, const VisitAll& visit_all) {
  Star<T> star;
  star.first.assign(features + 1, 0);
  visit_all([&](Index feature, const T&) { ++star.first[feature + 1]; });
  for (std::size_t i = 0; i < features; ++i) star.first[i + 1] += star.first[i];
  star.items.resize(star.first[features]);
  std::vector<std::uint32_t> next(star.first.begin(), star.first.end() - 1);
  visit_all([&](Index feature, const T& item) { star.items[next[feature]++] = item; });
  return star;
}

/// For each face 4 * cell + i the same face as 4 * cell + i of its other owner, kNone on the hull. The cells
/// must have passed check_tables and check_volumes. Throws MeshError for a duplicate cell, a face with three
/// owners, and two cells on the same side of a face.
std::vector<Index> match_faces(const TetraMesh& mesh);

/// The edges of a mesh, in the order of their ends.
struct EdgeNumbers {
  std::vector<std::array<Index, 2>> ends;  // ends[0] < ends[1]
  std::vector<Index> of_cell;              // of_cell[6 * cell + e] is the number of edge e of the cell
};
EdgeNumbers number_edges(const TetraMesh& mesh);

}  // namespace haptic::engine
