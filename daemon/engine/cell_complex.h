#pragma once
// The geometry that a HIP feels: space cut into tetrahedral cells, with everything that the state machine
// asks of it computed once (paper sections 2.1 and 2.4). Immutable after `build`, shared between threads
// without locks.
//
//        v3
//       /|`.         Plane i of a cell lies opposite its vertex i and looks inward:
//      / |  `.           side_i(p) = normal_i . p - offset_i   (m, positive inside)
//     /  |    `.
//   v0---|----v2     A face is shared by two cells. Its plane is stored once, positive toward cells[0],
//     `. |   .'      and each cell's record holds it, or its exact negative: the two cells can never
//       `|.'         disagree about a side.
//        v1
//
// The records are laid out for the order in which a tick asks: a cell alone answers "am I still inside" (its
// planes are in lanes of four), a face adds its rim only when a proxy slides on it, and stars are walked only
// at edges and vertices.

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "engine/box_tree.h"
#include "engine/proxy.h"

namespace haptic::engine {

/// What a complex is built from: plain vertices and cells, as a mesh file or a shape gives them.
struct TetraMesh {
  std::vector<glm::dvec3> vertices;  // m, object frame
  std::vector<std::array<Index, 4>>
      cells;                       // vertices of each cell; positive: (v1-v0) . ((v2-v0) x (v3-v0)) > 0
  std::vector<std::int32_t> tags;  // one for each cell: the region that it belongs to
};

/// A mesh that no complex can be built from. `cell` is the first offending cell, kNone where none can be
/// named.
class MeshError : public std::runtime_error {
 public:
  MeshError(const std::string& what, Index offending_cell) : std::runtime_error(what), cell(offending_cell) {}
  Index cell;
};

/// Points with normal . p = offset; `side` is the signed distance (m).
struct Plane {
  glm::dvec3 normal;
  double offset;
  double side(const glm::dvec3& p) const noexcept {
    return normal.x * p.x + normal.y * p.y + normal.z * p.z - offset;
  }
};

/// One tetrahedron. Lane i of the plane arrays belongs to the face opposite vertex i, looking inward.
struct alignas(64) Cell {
  std::array<double, 4> normal_x, normal_y, normal_z, offset;
  std::array<Index, 4> vertices;
  std::array<Index, 4> faces;
  std::array<Index, 4> neighbours;  // across face i; kNone outside the hull
  Index region;                     // index into CellComplex::region_tags()

  /// Signed distance to the plane of face i, positive inside (m).
  double side(int i, const glm::dvec3& p) const noexcept {
    const auto lane = static_cast<std::size_t>(i);
    return normal_x[lane] * p.x + normal_y[lane] * p.y + normal_z[lane] * p.z - offset[lane];
  }
};

/// One triangle between two cells, or between a cell and the outside.
struct Face {
  Plane plane;                 // positive toward cells[0]
  std::array<Index, 2> cells;  // cells[1] is kNone on the hull
};

/// The rim of a face: its three edges seen from inside the triangle.
struct FaceRim {
  std::array<Plane, 3> inward;    // in-plane unit normals of edges[i], positive inside the triangle
  std::array<Index, 3> vertices;  // counter-clockwise seen from cells[0]
  std::array<Index, 3> edges;     // edges[i] joins vertices[i] and vertices[(i + 1) % 3]
};

/// One edge; `ends[0] < ends[1]`, and `direction` points from the first to the second.
struct Edge {
  glm::dvec3 origin;     // position of ends[0], m
  double length;         // m
  glm::dvec3 direction;  // unit
  std::array<Index, 2> ends;
};

/// A cell around an edge, with the two of its planes that contain the edge.
struct EdgeCell {
  Index cell;
  std::array<std::uint8_t, 2> planes;
};

/// Lists of different lengths, one for each feature, end to end.
template <class T>
class Star {
 public:
  std::span<const T> operator[](Index feature) const noexcept {
    return {items.data() + first[feature], items.data() + first[feature + 1]};
  }
  std::vector<std::uint32_t> first;  // one more than there are features
  std::vector<T> items;
};

class CellComplex {
 public:
  /// Checks the mesh and computes all tables, in near-linear time; cells and vertices keep their numbers.
  /// Throws MeshError naming the first offending cell of the first of these checks that fails: sizes of the
  /// tables, indices, repeated vertices, non-finite coordinates; extent and distance from the origin;
  /// inverted and flat cells; coincident vertices; duplicate cells, faces with three owners, faces used twice
  /// on one side (overlapping cells). Not real-time safe.
  ///
  /// Coincident vertices are refused because cells that touch there without sharing a face would be torn
  /// apart: a proxy would pass from one to the other through Out, and nothing but this would tell. A hull
  /// that touches itself at a shared vertex or edge is permitted: stars list the cells of all fans. Not
  /// noticed are cells that overlap without sharing a face. A vertex that no cell uses is ignored: its stars
  /// are empty.
  static CellComplex build(const TetraMesh& mesh);

  std::span<const glm::dvec3> vertices() const noexcept { return vertices_; }
  std::span<const Cell> cells() const noexcept { return cells_; }
  std::span<const Face> faces() const noexcept { return faces_; }
  std::span<const FaceRim> rims() const noexcept { return rims_; }
  std::span<const Edge> edges() const noexcept { return edges_; }

  std::span<const EdgeCell> cells_of_edge(Index edge) const noexcept { return edge_cells_[edge]; }
  std::span<const Index> faces_of_edge(Index edge) const noexcept { return edge_faces_[edge]; }
  std::span<const Index> cells_of_vertex(Index vertex) const noexcept { return vertex_cells_[vertex]; }
  std::span<const Index> faces_of_vertex(Index vertex) const noexcept { return vertex_faces_[vertex]; }
  std::span<const Index> edges_of_vertex(Index vertex) const noexcept { return vertex_edges_[vertex]; }

  /// Faces with one cell only, in ascending order; item i of boundary_tree() is hull_faces()[i].
  std::span<const Index> hull_faces() const noexcept { return hull_faces_; }
  const BoxTree& boundary_tree() const noexcept { return boundary_tree_; }

  /// The tags that occur, ascending; Cell::region indexes them.
  std::span<const std::int32_t> region_tags() const noexcept { return region_tags_; }

  /// Bounding box (m, object frame).
  const Box& bounds() const noexcept { return bounds_; }

  /// The length below which two points are one (m): kLengthTolerance times the extent.
  double tolerance() const noexcept { return tolerance_; }

  /// The lowest cell that holds p, to within tolerance(); kNone if none does. Real-time safe: visits a
  /// bounded number of tree nodes.
  Index locate(const glm::dvec3& p) const noexcept {
    return locate_if(p, [](Index) { return true; });
  }

  /// The lowest cell that holds p and that `accept(cell)` takes; it is asked for every cell that holds p.
  template <class Accept>
  Index locate_if(const glm::dvec3& p, Accept&& accept) const noexcept;

  /// Bytes of all tables together.
  std::size_t bytes() const noexcept;

 private:
  void add_cells_and_faces(const TetraMesh& mesh);
  void add_edges(const TetraMesh& mesh);
  void add_stars();
  void add_trees();

  std::vector<glm::dvec3> vertices_;
  std::vector<Cell> cells_;
  std::vector<Face> faces_;
  std::vector<FaceRim> rims_;
  std::vector<Edge> edges_;
  Star<EdgeCell> edge_cells_;
  Star<Index> edge_faces_, vertex_cells_, vertex_faces_, vertex_edges_;
  std::vector<Index> hull_faces_;
  std::vector<std::int32_t> region_tags_;
  BoxTree boundary_tree_;  // over hull_faces_
  BoxTree cell_tree_;      // over cells_
  Box bounds_;
  double tolerance_ = 0.0;
};

template <class Accept>
Index CellComplex::locate_if(const glm::dvec3& p, Accept&& accept) const noexcept {
  Index found = kNone;
  const Box point{p - tolerance_, p + tolerance_};
  cell_tree_.visit_overlaps(point, [&](Index index) {
    const Cell& cell = cells_[index];
    for (int i = 0; i < 4; ++i) {
      if (!(cell.side(i, p) >= -tolerance_)) return;
    }
    if (accept(index) && index < found) found = index;
  });
  return found;
}

}  // namespace haptic::engine
