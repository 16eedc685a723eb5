#include "engine/mesh_check.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "engine/constants.h"
#include "engine/message.h"

namespace haptic::engine {
namespace {

bool is_finite(const glm::dvec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

template <class... Parts>
[[noreturn]] void refuse(Index cell, const Parts&... parts) {
  throw MeshError(message(parts...), cell);
}

void check_sizes(const TetraMesh& mesh) {
  const std::size_t cells = mesh.cells.size();
  if (cells == 0) refuse(kNone, "the mesh has no cells");
  if (cells != mesh.tags.size())
    refuse(kNone, "the mesh has ", cells, " cells but ", mesh.tags.size(), " tags");
  if (cells > kMaxCells)
    refuse(kNone, "the mesh has ", cells, " cells; at most ", kMaxCells, " are possible");
  if (mesh.vertices.size() >= kNone) {
    refuse(kNone, "the mesh has ", mesh.vertices.size(), " vertices; at most ", kNone - 1, " are possible");
  }
}

/// 6 times the signed volume over twice the largest face: the signed smallest altitude (m).
double smallest_altitude(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d) {
  const glm::dvec3 ab = b - a;
  const glm::dvec3 ac = c - a;
  const glm::dvec3 ad = d - a;
  const double largest = std::max({glm::length(glm::cross(ab, ac)), glm::length(glm::cross(ac, ad)),
                                   glm::length(glm::cross(ad, ab)), glm::length(glm::cross(c - b, d - b))});
  return largest > 0.0 ? glm::dot(ab, glm::cross(ac, ad)) / largest : 0.0;
}

/// A vertex in a grid whose boxes are one tolerance wide.
struct GridVertex {
  std::array<std::int64_t, 3> box;
  Index vertex;
};

std::vector<GridVertex> sort_into_grid(const TetraMesh& mesh, const Box& bounds, double width) {
  std::vector<bool> used(mesh.vertices.size(), false);
  for (const auto& cell : mesh.cells) {
    for (const Index v : cell) used[v] = true;
  }
  std::vector<GridVertex> grid;
  grid.reserve(mesh.vertices.size());
  for (Index v = 0; v < mesh.vertices.size(); ++v) {
    if (!used[v]) continue;
    const glm::dvec3 at = glm::floor((mesh.vertices[v] - bounds.low) / width);
    grid.push_back(
        {{static_cast<std::int64_t>(at.x), static_cast<std::int64_t>(at.y), static_cast<std::int64_t>(at.z)},
         v});
  }
  std::sort(grid.begin(), grid.end(), [](const GridVertex& a, const GridVertex& b) {
    return a.box != b.box ? a.box < b.box : a.vertex < b.vertex;
  });
  return grid;
}

[[noreturn]] void refuse_coincident(const TetraMesh& mesh, Index a, Index b) {
  const Index later = std::max(a, b);
  Index cell = 0;
  while (std::find(mesh.cells[cell].begin(), mesh.cells[cell].end(), later) == mesh.cells[cell].end()) ++cell;
  refuse(cell, describe_cell(mesh, cell), ": vertex ", later, " is at the place of vertex ", std::min(a, b),
         " (", glm::distance(mesh.vertices[a], mesh.vertices[b]),
         " m apart), which tears the mesh apart there; weld them");
}

}  // namespace

std::string describe_cell(const TetraMesh& mesh, Index cell) {
  const auto& v = mesh.cells[cell];
  return message("cell ", cell, " (vertices ", v[0], ", ", v[1], ", ", v[2], ", ", v[3], ")");
}

Box check_tables(const TetraMesh& mesh) {
  check_sizes(mesh);
  Box bounds;
  for (Index c = 0; c < mesh.cells.size(); ++c) {
    const auto& cell = mesh.cells[c];
    for (std::size_t i = 0; i < 4; ++i) {
      if (cell[i] >= mesh.vertices.size()) {
        refuse(c, describe_cell(mesh, c), ": vertex ", cell[i], " is out of range; the mesh has ",
               mesh.vertices.size(), " vertices");
      }
      if (std::find(cell.begin(), cell.begin() + static_cast<std::ptrdiff_t>(i), cell[i]) !=
          cell.begin() + static_cast<std::ptrdiff_t>(i)) {
        refuse(c, describe_cell(mesh, c), ": vertex ", cell[i], " is repeated");
      }
      const glm::dvec3& p = mesh.vertices[cell[i]];
      if (!is_finite(p)) {
        refuse(c, describe_cell(mesh, c), ": vertex ", cell[i], " is not finite: ", p.x, ", ", p.y, ", ",
               p.z);
      }
      bounds.add(p);
    }
  }
  const double extent = glm::distance(bounds.low, bounds.high);
  if (!(extent >= kSmallestExtent && extent <= kLargestExtent)) {
    refuse(kNone, "the mesh has an extent of ", extent, " m; permitted are ", kSmallestExtent, " to ",
           kLargestExtent, " m");
  }
  const double farthest = std::max(glm::length(bounds.low), glm::length(bounds.high));
  if (farthest > kFarthest * extent) {
    refuse(kNone, "the mesh lies ", farthest, " m from its origin, more than ", kFarthest,
           " times its extent of ", extent, " m: its coordinates are too coarse");
  }
  return bounds;
}

void check_volumes(const TetraMesh& mesh, double extent) {
  const double smallest = kFlatCell * extent;
  for (Index c = 0; c < mesh.cells.size(); ++c) {
    const auto& v = mesh.cells[c];
    const double altitude =
        smallest_altitude(mesh.vertices[v[0]], mesh.vertices[v[1]], mesh.vertices[v[2]], mesh.vertices[v[3]]);
    if (altitude <= -smallest) {
      refuse(c, describe_cell(mesh, c), " is inverted: its smallest altitude is ", altitude,
             " m; exchange two of its vertices");
    }
    if (!(altitude >= smallest)) {
      refuse(c, describe_cell(mesh, c), " is flat: its smallest altitude is ", altitude, " m, at least ",
             smallest, " m is needed");
    }
  }
}

void check_coincident(const TetraMesh& mesh, const Box& bounds, double tolerance) {
  const std::vector<GridVertex> grid = sort_into_grid(mesh, bounds, tolerance);
  const auto compare = [&](const GridVertex& a, const GridVertex& b) {
    if (glm::distance(mesh.vertices[a.vertex], mesh.vertices[b.vertex]) <= tolerance) {
      refuse_coincident(mesh, a.vertex, b.vertex);
    }
  };
  // each box against itself and half of its 26 neighbours; a shifted grid keeps its order, so that the
  // partner only moves on. A box without coincident vertices holds a few at most.
  for (std::int64_t shift = 13; shift < 27; ++shift) {
    const std::array<std::int64_t, 3> step{shift / 9 - 1, shift / 3 % 3 - 1, shift % 3 - 1};
    std::size_t partner = 0;
    for (std::size_t i = 0; i < grid.size(); ++i) {
      const auto& box = grid[i].box;
      const std::array<std::int64_t, 3> target{box[0] + step[0], box[1] + step[1], box[2] + step[2]};
      while (partner < grid.size() && grid[partner].box < target) ++partner;
      const std::size_t first = shift == 13 ? i + 1 : partner;
      for (std::size_t j = first; j < grid.size() && grid[j].box == target; ++j) compare(grid[i], grid[j]);
    }
  }
}

}  // namespace haptic::engine
