// icosphere_mesh: concentric layers of icospheres, the surface being the finest. From it the layers grow
// coarser by one subdivision each, inward down to an icosahedron around the centre and outward as far as the
// air goes. Between a triangle of the coarser layer and its four children on the finer one lie seven cells:
//
//          A'---ab'---B'      one under each outer child, from its corner: A A' ab' ca', and so for B and C;
//          | \  / \  / |      four around the diagonal from A to bc' of the octahedron that is left between
//          |  \/   \/  |      A B C and ab' bc' ca'.
//          A-----------B

#include <glm/geometric.hpp>
#include <map>
#include <utility>

#include "engine/cell_builder.h"
#include "engine/shapes.h"

namespace haptic::engine {
namespace {

constexpr int kMaxSubdivisions = 7;

/// Thickness of a layer between level k - 1 and level k, times 2^k, over the radius of level k: about three
/// quarters of an edge, for cells about as thick as wide.
constexpr double kLayerThickness = 0.75;

/// What coarse hull triangles may take from the air margin where they cut below the sphere.
constexpr double kSagPart = 0.1;

using Triangle = std::array<Index, 3>;

/// Icospheres of radius 1, each on the vertices of the one before and its own. The children of triangle t are
/// 4 t to 4 t + 3: at its corners in order, and in its middle.
struct Levels {
  std::vector<glm::dvec3> directions;
  std::vector<std::vector<Triangle>> triangles;  // by level, seen counter-clockwise from outside

  static Index vertices(int level) { return 10 * (1U << (2 * level)) + 2; }
};

Levels make_levels(int subdivisions) {
  const double golden = 0.5 * (1.0 + glm::sqrt(5.0));
  Levels levels;
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i < 4; ++i) {
      glm::dvec3 v{0.0};
      v[axis] = (i & 1) != 0 ? 1.0 : -1.0;
      v[(axis + 1) % 3] = (i & 2) != 0 ? golden : -golden;
      levels.directions.push_back(glm::normalize(v));
    }
  }
  levels.triangles.push_back({{0, 4, 1},   {0, 1, 6},  {0, 8, 4},   {0, 6, 9},  {0, 9, 8},
                              {1, 4, 10},  {1, 11, 6}, {1, 10, 11}, {2, 3, 5},  {2, 7, 3},
                              {2, 5, 8},   {2, 9, 7},  {2, 8, 9},   {3, 10, 5}, {3, 7, 11},
                              {3, 11, 10}, {4, 8, 5},  {4, 5, 10},  {6, 7, 9},  {6, 11, 7}});

  for (int level = 0; level < subdivisions; ++level) {
    std::map<std::pair<Index, Index>, Index> middles;
    const auto middle = [&](Index a, Index b) {
      const auto [entry, is_new] = middles.try_emplace(std::minmax(a, b), levels.directions.size());
      if (is_new) levels.directions.push_back(glm::normalize(levels.directions[a] + levels.directions[b]));
      return entry->second;
    };
    std::vector<Triangle> children;
    for (const auto& [a, b, c] : levels.triangles.back()) {
      const Index ab = middle(a, b);
      const Index bc = middle(b, c);
      const Index ca = middle(c, a);
      children.insert(children.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    levels.triangles.push_back(std::move(children));
  }
  return levels;
}

/// Distance of the planes of a level's triangles from the centre: the least, over the radius.
double least_inradius(const Levels& levels, int level) {
  double least = 1.0;
  for (const auto& [a, b, c] : levels.triangles[static_cast<std::size_t>(level)]) {
    const glm::dvec3& p = levels.directions[a];
    const glm::dvec3 normal = glm::normalize(glm::cross(levels.directions[b] - p, levels.directions[c] - p));
    least = std::min(least, glm::dot(normal, p));
  }
  return least;
}

/// One layer's vertices in the mesh.
struct Layer {
  int level;
  double radius;
  Index first;
};

class Onion {
 public:
  explicit Onion(int subdivisions) : levels_(make_levels(subdivisions)) {}

  Layer add_layer(int level, double radius) {
    const auto first = static_cast<Index>(mesh_.vertices.size());
    for (Index i = 0; i < Levels::vertices(level); ++i)
      mesh_.vertices.push_back(radius * levels_.directions[i]);
    return {level, radius, first};
  }

  /// Cells between two layers of the same level.
  void fill_equal(const Layer& a, const Layer& b, std::int32_t tag) {
    for (const Triangle& t : triangles(a.level)) {
      add_prism(mesh_, {a.first + t[0], a.first + t[1], a.first + t[2]},
                {b.first + t[0], b.first + t[1], b.first + t[2]}, tag);
    }
  }

  /// Cells between a layer and one coarser by a level.
  void fill_coarser(const Layer& fine, const Layer& coarse, std::int32_t tag) {
    for (std::size_t t = 0; t < triangles(coarse.level).size(); ++t) {
      const Triangle& parent = triangles(coarse.level)[t];
      const Triangle& child = triangles(fine.level)[4 * t + 3];
      std::array<Index, 3> inner;   // the parent's corners
      std::array<Index, 3> outer;   // those of its children beside them
      std::array<Index, 3> middle;  // the middle child's: of edges 01, 12, 20
      for (std::size_t k = 0; k < 3; ++k) {
        inner[k] = coarse.first + parent[k];
        outer[k] = fine.first + parent[k];
        middle[k] = fine.first + child[k];
      }
      for (std::size_t k = 0; k < 3; ++k) {
        add_cell(mesh_, {inner[k], outer[k], middle[k], middle[(k + 2) % 3]}, tag);
      }
      const std::array<Index, 4> around{inner[1], inner[2], middle[2], middle[0]};
      for (std::size_t k = 0; k < 4; ++k) {
        add_cell(mesh_, {inner[0], middle[1], around[k], around[(k + 1) % 4]}, tag);
      }
    }
  }

  void fill_core(const Layer& layer, std::int32_t tag) {
    const auto centre = static_cast<Index>(mesh_.vertices.size());
    mesh_.vertices.emplace_back(0.0);
    for (const Triangle& t : triangles(layer.level)) {
      add_cell(mesh_, {centre, layer.first + t[0], layer.first + t[1], layer.first + t[2]}, tag);
    }
  }

  void fill_inside(Layer layer) {
    while (layer.level > 0) {
      const double radius = layer.radius * (1.0 - kLayerThickness / (1 << layer.level));
      const Layer inner = add_layer(layer.level - 1, radius);
      fill_coarser(layer, inner, kInside);
      layer = inner;
    }
    fill_core(layer, kInside);
  }

  void fill_air(Layer layer, double air_margin) {
    const double last = layer.radius + air_margin;
    while (layer.level > 0) {
      // a layer as thick again must fit between this one and the hull
      const double radius = layer.radius * (1.0 + kLayerThickness / (1 << layer.level));
      const double sag = last * (1.0 - least_inradius(levels_, layer.level - 1));
      if (2.0 * radius - layer.radius > last || sag > kSagPart * air_margin) break;
      const Layer outer = add_layer(layer.level - 1, radius);
      fill_coarser(layer, outer, kOutside);
      layer = outer;
    }
    const double ideal = 2.0 * kLayerThickness * layer.radius / (1 << layer.level);
    const int count = std::max(1, static_cast<int>((last - layer.radius) / ideal));
    const double step = (last - layer.radius) / count;
    const double start = layer.radius;
    for (int i = 1; i <= count; ++i) {
      const Layer outer = add_layer(layer.level, i == count ? last : start + i * step);
      fill_equal(layer, outer, kOutside);
      layer = outer;
    }
  }

  TetraMesh take() { return std::move(mesh_); }

 private:
  const std::vector<Triangle>& triangles(int level) const {
    return levels_.triangles[static_cast<std::size_t>(level)];
  }

  Levels levels_;
  TetraMesh mesh_;
};

}  // namespace

TetraMesh icosphere_mesh(double radius, int subdivisions, double air_margin) {
  const std::array<Length, 1> lengths{{{"radius", radius}}};
  require_lengths(lengths);
  require(subdivisions >= 0 && subdivisions <= kMaxSubdivisions, "subdivisions is ", subdivisions,
          "; permitted are 0 to ", kMaxSubdivisions);
  require_margin(air_margin, radius);

  Onion onion(subdivisions);
  const Layer surface = onion.add_layer(subdivisions, radius);
  onion.fill_inside(surface);
  if (air_margin > 0.0) onion.fill_air(surface, air_margin);
  return onion.take();
}

}  // namespace haptic::engine
