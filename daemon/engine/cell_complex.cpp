#include "engine/cell_complex.h"

#include <algorithm>
#include <glm/geometric.hpp>

#include "engine/cell_topology.h"
#include "engine/constants.h"
#include "engine/mesh_check.h"

namespace haptic::engine {
namespace {

using Triangle = std::array<glm::dvec3, 3>;

/// The plane of a triangle, positive where it is seen counter-clockwise.
Plane plane_of(const Triangle& p) {
  std::size_t longest = 0;  // the edge opposite this corner
  double length = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double d = glm::distance(p[(k + 1) % 3], p[(k + 2) % 3]);
    if (d > length) {
      longest = k;
      length = d;
    }
  }
  const glm::dvec3& tip = p[longest];
  const glm::dvec3& from = p[(longest + 1) % 3];
  const glm::dvec3& to = p[(longest + 2) % 3];
  // the two shorter edges round least. What error is left along the longest edge would tilt the plane out of
  // its own corners; across it the triangle is narrow and the error does no harm.
  const glm::dvec3 along = (to - from) / length;
  glm::dvec3 normal = glm::normalize(glm::cross(from - tip, to - tip));
  normal = glm::normalize(normal - glm::dot(normal, along) * along);
  return {normal, (glm::dot(normal, p[0]) + glm::dot(normal, p[1]) + glm::dot(normal, p[2])) / 3.0};
}

/// The plane through an edge of a triangle, across the triangle's own, positive inside it.
Plane rim_plane(const glm::dvec3& normal, const glm::dvec3& from, const glm::dvec3& to) {
  const glm::dvec3 inward = glm::normalize(glm::cross(normal, to - from));
  return {inward, 0.5 * (glm::dot(inward, from) + glm::dot(inward, to))};
}

/// Number of the edge between two vertices of a cell.
std::size_t edge_between(std::uint8_t a, std::uint8_t b) {
  const auto [low, high] = std::minmax(a, b);
  return low == 0 ? high - 1U : low + high;
}

void set_lane(Cell& cell, std::size_t lane, const Plane& plane, double sign) {
  cell.normal_x[lane] = sign * plane.normal.x;
  cell.normal_y[lane] = sign * plane.normal.y;
  cell.normal_z[lane] = sign * plane.normal.z;
  cell.offset[lane] = sign * plane.offset;
}

std::vector<std::int32_t> distinct(std::vector<std::int32_t> tags) {
  std::sort(tags.begin(), tags.end());
  tags.erase(std::unique(tags.begin(), tags.end()), tags.end());
  return tags;
}

template <class T>
std::size_t bytes_of(const std::vector<T>& table) {
  return table.size() * sizeof(T);
}

template <class T>
std::size_t bytes_of(const Star<T>& star) {
  return bytes_of(star.first) + bytes_of(star.items);
}

}  // namespace

CellComplex CellComplex::build(const TetraMesh& mesh) {
  CellComplex complex;
  complex.bounds_ = check_tables(mesh);
  const double extent = glm::distance(complex.bounds_.low, complex.bounds_.high);
  complex.tolerance_ = kLengthTolerance * extent;
  check_volumes(mesh, extent);
  check_coincident(mesh, complex.bounds_, complex.tolerance_);

  complex.vertices_ = mesh.vertices;
  complex.region_tags_ = distinct(mesh.tags);
  complex.add_cells_and_faces(mesh);
  complex.add_edges(mesh);
  complex.add_stars();
  complex.add_trees();
  return complex;
}

void CellComplex::add_cells_and_faces(const TetraMesh& mesh) {
  const std::vector<Index> partner = match_faces(mesh);
  const auto hull = static_cast<std::size_t>(std::count(partner.begin(), partner.end(), kNone));
  cells_.resize(mesh.cells.size());
  faces_.reserve((partner.size() + hull) / 2);
  rims_.reserve(faces_.capacity());
  hull_faces_.reserve(hull);

  for (Index c = 0; c < cells_.size(); ++c) {
    Cell& cell = cells_[c];
    cell.vertices = mesh.cells[c];
    const auto tag = std::lower_bound(region_tags_.begin(), region_tags_.end(), mesh.tags[c]);
    cell.region = static_cast<Index>(tag - region_tags_.begin());
    for (std::size_t i = 0; i < 4; ++i) {
      const Index other = partner[4 * std::size_t{c} + i];
      cell.neighbours[i] = other == kNone ? kNone : other / 4;
      if (other != kNone && other / 4 < c) {  // the other cell has brought the face
        cell.faces[i] = cells_[other / 4].faces[other % 4];
        set_lane(cell, i, faces_[cell.faces[i]].plane, -1.0);
        continue;
      }
      FaceRim rim{};
      Triangle corners;
      for (std::size_t k = 0; k < 3; ++k) {
        rim.vertices[k] = cell.vertices[kFaceCorners[i][k]];
        corners[k] = vertices_[rim.vertices[k]];
      }
      const Face face{plane_of(corners), {c, cell.neighbours[i]}};
      for (std::size_t k = 0; k < 3; ++k) {
        rim.inward[k] = rim_plane(face.plane.normal, corners[k], corners[(k + 1) % 3]);
      }
      cell.faces[i] = static_cast<Index>(faces_.size());
      set_lane(cell, i, face.plane, 1.0);
      if (other == kNone) hull_faces_.push_back(cell.faces[i]);
      faces_.push_back(face);
      rims_.push_back(rim);
    }
  }
}

void CellComplex::add_edges(const TetraMesh& mesh) {
  const EdgeNumbers numbers = number_edges(mesh);
  edges_.reserve(numbers.ends.size());
  for (const auto& ends : numbers.ends) {
    const glm::dvec3 span = vertices_[ends[1]] - vertices_[ends[0]];
    const double length = glm::length(span);
    edges_.push_back({vertices_[ends[0]], length, span / length, ends});
  }
  for (Index c = 0; c < cells_.size(); ++c) {
    for (std::size_t i = 0; i < 4; ++i) {
      if (faces_[cells_[c].faces[i]].cells[0] != c) continue;
      const auto& corners = kFaceCorners[i];
      for (std::size_t k = 0; k < 3; ++k) {
        rims_[cells_[c].faces[i]].edges[k] =
            numbers.of_cell[6 * std::size_t{c} + edge_between(corners[k], corners[(k + 1) % 3])];
      }
    }
  }
  edge_cells_ = make_star<EdgeCell>(edges_.size(), [&](const auto& visit) {
    for (std::size_t use = 0; use < numbers.of_cell.size(); ++use) {
      visit(numbers.of_cell[use], EdgeCell{static_cast<Index>(use / 6), kEdgeEnds[5 - use % 6]});
    }
  });
}

void CellComplex::add_stars() {
  edge_faces_ = make_star<Index>(edges_.size(), [&](const auto& visit) {
    for (Index f = 0; f < rims_.size(); ++f) {
      for (const Index edge : rims_[f].edges) visit(edge, f);
    }
  });
  vertex_faces_ = make_star<Index>(vertices_.size(), [&](const auto& visit) {
    for (Index f = 0; f < rims_.size(); ++f) {
      for (const Index vertex : rims_[f].vertices) visit(vertex, f);
    }
  });
  vertex_cells_ = make_star<Index>(vertices_.size(), [&](const auto& visit) {
    for (Index c = 0; c < cells_.size(); ++c) {
      for (const Index vertex : cells_[c].vertices) visit(vertex, c);
    }
  });
  vertex_edges_ = make_star<Index>(vertices_.size(), [&](const auto& visit) {
    for (Index e = 0; e < edges_.size(); ++e) {
      for (const Index vertex : edges_[e].ends) visit(vertex, e);
    }
  });
}

void CellComplex::add_trees() {
  std::vector<Box> boxes(hull_faces_.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (const Index vertex : rims_[hull_faces_[i]].vertices) boxes[i].add(vertices_[vertex]);
  }
  boundary_tree_ = BoxTree(boxes);
  boxes.assign(cells_.size(), Box{});
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    for (const Index vertex : cells_[c].vertices) boxes[c].add(vertices_[vertex]);
  }
  cell_tree_ = BoxTree(boxes);
}

std::size_t CellComplex::bytes() const noexcept {
  return bytes_of(vertices_) + bytes_of(cells_) + bytes_of(faces_) + bytes_of(rims_) + bytes_of(edges_) +
         bytes_of(edge_cells_) + bytes_of(edge_faces_) + bytes_of(vertex_cells_) + bytes_of(vertex_faces_) +
         bytes_of(vertex_edges_) + bytes_of(hull_faces_) + bytes_of(region_tags_) + boundary_tree_.bytes() +
         cell_tree_.bytes();
}

}  // namespace haptic::engine
