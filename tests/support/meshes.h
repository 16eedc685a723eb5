#pragma once
// Meshes that tests share. All are conforming and positive; lengths in m.

#include <algorithm>
#include <array>
#include <functional>
#include <glm/vec3.hpp>
#include <numeric>
#include <random>
#include <vector>

#include "engine/cell_complex.h"

namespace haptic::test {

using engine::Index;
using engine::TetraMesh;

/// The corner at the origin, and one vertex on each axis at distance `size`.
inline TetraMesh corner_cell(double size = 1.0) {
  return {{{0, 0, 0}, {size, 0, 0}, {0, size, 0}, {0, 0, size}}, {{0, 1, 2, 3}}, {0}};
}

/// A grid of `count` cubes from `low` to `high`, each cut into the six cells of Kuhn around its diagonal. The
/// tag of a cube's cells is tag_of(its centre).
inline TetraMesh kuhn_grid(const std::array<int, 3>& count, const glm::dvec3& low, const glm::dvec3& high,
                           const std::function<std::int32_t(const glm::dvec3&)>& tag_of) {
  TetraMesh mesh;
  const auto at = [&](int x, int y, int z) {
    return static_cast<Index>((x * (count[1] + 1) + y) * (count[2] + 1) + z);
  };
  const auto place = [&](double x, double y, double z) {
    return low + (high - low) * glm::dvec3{x / count[0], y / count[1], z / count[2]};
  };
  for (int x = 0; x <= count[0]; ++x) {
    for (int y = 0; y <= count[1]; ++y) {
      for (int z = 0; z <= count[2]; ++z) mesh.vertices.push_back(place(x, y, z));
    }
  }
  std::array<std::size_t, 3> axes{0, 1, 2};
  do {  // each order of the axes is a walk along edges from the low corner to the high one
    const bool odd = (axes[0] > axes[1]) != ((axes[0] > axes[2]) != (axes[1] > axes[2]));
    for (int x = 0; x < count[0]; ++x) {
      for (int y = 0; y < count[1]; ++y) {
        for (int z = 0; z < count[2]; ++z) {
          std::array<int, 3> corner{x, y, z};
          std::array<Index, 4> cell{};
          cell[0] = at(x, y, z);
          for (std::size_t k = 0; k < 3; ++k) {
            ++corner[axes[k]];
            cell[k + 1] = at(corner[0], corner[1], corner[2]);
          }
          if (odd) std::swap(cell[0], cell[1]);
          mesh.cells.push_back(cell);
          mesh.tags.push_back(tag_of(place(x + 0.5, y + 0.5, z + 0.5)));
        }
      }
    }
  } while (std::next_permutation(axes.begin(), axes.end()));
  return mesh;
}

/// A cube of edge `size` around the origin, n cubes along each edge, of one region 0.
inline TetraMesh kuhn_cube(int n, double size = 1.0) {
  const glm::dvec3 half{0.5 * size};
  return kuhn_grid({n, n, n}, -half, half, [](const glm::dvec3&) { return 0; });
}

/// An L of region 1 in air (region 0), with concave edges and corners around the air cube
/// x > 0.1, y > 0.1. The L fills 0 to 0.2 in x, y and 0 to 0.1 in z; the air goes 0.1 further on all sides.
/// `n` cubes for each 0.1 m.
inline TetraMesh l_block(int n = 1) {
  return kuhn_grid({4 * n, 4 * n, 3 * n}, glm::dvec3{-0.1}, {0.3, 0.3, 0.2}, [](const glm::dvec3& p) {
    const bool in_box = p.x > 0.0 && p.x < 0.2 && p.y > 0.0 && p.y < 0.2 && p.z > 0.0 && p.z < 0.1;
    return in_box && !(p.x > 0.1 && p.y > 0.1) ? 1 : 0;
  });
}

/// A plate of region 1, 0.1 x 0.1 m and `thickness` thick in z, one layer of cells, between air of 0.05 m
/// above and below. `n` cubes along x and y.
inline TetraMesh thin_plate(double thickness, int n = 4) {
  // an even grid in z (below, plate, above) whose two inner levels are then moved to the plate's faces
  TetraMesh mesh = kuhn_grid({n, n, 3}, {-0.05, -0.05, -1.5}, {0.05, 0.05, 1.5},
                             [](const glm::dvec3& p) { return p.z > -0.5 && p.z < 0.5 ? 1 : 0; });
  for (glm::dvec3& v : mesh.vertices) {
    const double beyond = v.z > 1.0 ? 0.05 : (v.z < -1.0 ? -0.05 : 0.0);
    v.z = (v.z > 0.0 ? 0.5 : -0.5) * thickness + beyond;
  }
  return mesh;
}

/// The same mesh with vertices, cells and the vertices within each cell renumbered at random.
inline TetraMesh shuffled(const TetraMesh& mesh, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<Index> vertex(mesh.vertices.size());
  std::vector<std::size_t> cell(mesh.cells.size());
  std::iota(vertex.begin(), vertex.end(), 0U);
  std::iota(cell.begin(), cell.end(), 0U);
  std::shuffle(vertex.begin(), vertex.end(), random);
  std::shuffle(cell.begin(), cell.end(), random);
  TetraMesh result;
  result.vertices.resize(mesh.vertices.size());
  for (std::size_t v = 0; v < vertex.size(); ++v) result.vertices[vertex[v]] = mesh.vertices[v];
  for (const std::size_t c : cell) {
    std::array<Index, 4> v{};
    for (std::size_t i = 0; i < 4; ++i) v[i] = vertex[mesh.cells[c][i]];
    const auto first = static_cast<std::ptrdiff_t>(random() % 2);  // turn three of them: an even permutation
    std::rotate(v.begin() + first, v.begin() + first + 1, v.begin() + first + 3);
    result.cells.push_back(v);
    result.tags.push_back(mesh.tags[c]);
  }
  return result;
}

}  // namespace haptic::test
