#include "engine/delaunay.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <tuple>
#include <utility>

#include "engine/shapes.h"

namespace haptic::engine {
namespace {

using glm::dvec2;

/// A triangle is slim if its circumradius exceeds this many times its shortest edge: an angle below 14.5
/// degrees. Up to the square root of 2 the refinement is known to end.
constexpr double kSlim = 2.0;

/// Sine by which two angles across an edge must exceed a half turn for a flip: rounding alone never flips.
constexpr double kFlipMargin = 1e-9;

/// Points that may be added for each that was there: far above what outlines were seen to need.
constexpr std::size_t kPointsPerPoint = 4;
constexpr std::size_t kExtraPoints = 64;

double cross(const dvec2& a, const dvec2& b) { return a.x * b.y - a.y * b.x; }

class Refiner {
 public:
  explicit Refiner(PlaneMesh& mesh) : mesh_(mesh), neighbours_(mesh.triangles.size(), {kNone, kNone, kNone}) {
    connect();
    for (Index t = 0; t < mesh_.triangles.size(); ++t) mark(t);
    flip_marked();
  }

  void add_points() {
    const std::size_t limit = mesh_.points.size() * (1 + kPointsPerPoint) + kExtraPoints;
    bool added = true;
    while (added) {
      added = false;
      for (Index t = 0; t < mesh_.triangles.size() && mesh_.points.size() < limit; ++t) {
        if (is_slim(t) && add_point_for(t)) added = true;
      }
    }
  }

 private:
  struct Place {
    Index triangle, edge;
  };

  const dvec2& corner(Index t, Index k) const { return mesh_.points[mesh_.triangles[t][k % 3]]; }

  void connect() {
    struct Side {
      Index low, high, triangle, edge;
    };
    std::vector<Side> sides;
    for (Index t = 0; t < mesh_.triangles.size(); ++t) {
      for (Index k = 0; k < 3; ++k) {
        const auto [low, high] = std::minmax(mesh_.triangles[t][k], mesh_.triangles[t][(k + 1) % 3]);
        sides.push_back({low, high, t, k});
      }
    }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
      return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
    });
    for (std::size_t i = 1; i < sides.size(); ++i) {
      const Side& a = sides[i - 1];
      const Side& b = sides[i];
      if (a.low != b.low || a.high != b.high) continue;
      neighbours_[a.triangle][a.edge] = b.triangle;
      neighbours_[b.triangle][b.edge] = a.triangle;
    }
  }

  bool is_rim(Index t, Index k) const { return neighbours_[t][k] == kNone; }
  bool is_fixed(Index t, Index k) const {
    return is_rim(t, k) || mesh_.tags[t] != mesh_.tags[neighbours_[t][k]];
  }

  Index edge_toward(Index t, Index neighbour) const {
    return static_cast<Index>(std::find(neighbours_[t].begin(), neighbours_[t].end(), neighbour) -
                              neighbours_[t].begin());
  }

  void replace_neighbour(Index t, Index old_one, Index new_one) {
    if (t != kNone) neighbours_[t][edge_toward(t, old_one)] = new_one;
  }

  void mark(Index t) {
    for (Index k = 0; k < 3; ++k) marked_.push_back({t, k});
  }

  /// Whether the angles across edge k of t sum to more than a half turn.
  bool wants_flip(Index t, Index k) const {
    if (is_fixed(t, k)) return false;
    const Index other = neighbours_[t][k];
    const dvec2& a = corner(t, k);
    const dvec2& b = corner(t, k + 1);
    const dvec2 ca = a - corner(t, k + 2);
    const dvec2 cb = b - corner(t, k + 2);
    const dvec2& d = corner(other, edge_toward(other, t) + 2);
    const dvec2 da = a - d;
    const dvec2 db = b - d;
    const double sine = cross(ca, cb) * glm::dot(da, db) + glm::dot(ca, cb) * cross(db, da);
    return sine < -kFlipMargin * glm::length(ca) * glm::length(cb) * glm::length(da) * glm::length(db);
  }

  void flip(Index t, Index k) {
    const Index u = neighbours_[t][k];
    const Index j = edge_toward(u, t);
    const auto vt = mesh_.triangles[t];
    const auto nt = neighbours_[t];
    const auto vu = mesh_.triangles[u];
    const auto nu = neighbours_[u];
    const Index a = vt[k];
    const Index b = vt[(k + 1) % 3];
    const Index c = vt[(k + 2) % 3];
    const Index d = vu[(j + 2) % 3];
    mesh_.triangles[t] = {c, a, d};
    neighbours_[t] = {nt[(k + 2) % 3], nu[(j + 1) % 3], u};
    mesh_.triangles[u] = {d, b, c};
    neighbours_[u] = {nu[(j + 2) % 3], nt[(k + 1) % 3], t};
    replace_neighbour(neighbours_[t][1], u, t);
    replace_neighbour(neighbours_[u][1], t, u);
    mark(t);
    mark(u);
  }

  void flip_marked() {
    while (!marked_.empty()) {
      const Place place = marked_.back();
      marked_.pop_back();
      if (wants_flip(place.triangle, place.edge)) flip(place.triangle, place.edge);
    }
  }

  dvec2 circumcentre(Index t) const {
    const dvec2& a = corner(t, 0);
    const dvec2 ab = corner(t, 1) - a;
    const dvec2 ac = corner(t, 2) - a;
    const dvec2 v = glm::dot(ab, ab) * ac - glm::dot(ac, ac) * ab;
    return a + dvec2{v.y, -v.x} / (2.0 * cross(ab, ac));
  }

  bool is_slim(Index t) const {
    double shortest = glm::distance(corner(t, 2), corner(t, 0));
    for (Index k = 0; k < 2; ++k)
      shortest = std::min(shortest, glm::distance(corner(t, k), corner(t, k + 1)));
    return glm::distance(circumcentre(t), corner(t, 0)) > kSlim * shortest;
  }

  /// Whether p lies in the circle that has edge k of t as its diameter.
  bool is_encroached(Index t, Index k, const dvec2& p) const {
    return glm::dot(corner(t, k) - p, corner(t, k + 1) - p) < 0.0;
  }

  /// Adds the circumcentre of t, or, where that comes too near to the rim of the air, the middle of a rim
  /// edge.
  bool add_point_for(Index t) {
    const dvec2 p = circumcentre(t);
    // walk to the triangle that holds p
    for (std::size_t steps = 0; steps < mesh_.triangles.size(); ++steps) {
      Index leave = kNone;
      for (Index k = 0; k < 3; ++k) {
        if (is_fixed(t, k) && is_encroached(t, k, p)) return divide_rim(t, k);
        if (cross(corner(t, k + 1) - corner(t, k), p - corner(t, k)) < 0.0 && leave == kNone) leave = k;
      }
      if (leave == kNone) return add_inside(t, p);
      if (is_fixed(t, leave)) return divide_rim(t, leave);
      t = neighbours_[t][leave];
    }
    return false;
  }

  Index new_triangle(Index like) {
    mesh_.triangles.emplace_back();
    neighbours_.push_back({kNone, kNone, kNone});
    mesh_.tags.push_back(mesh_.tags[like]);
    return static_cast<Index>(mesh_.triangles.size() - 1);
  }

  bool add_inside(Index t, const dvec2& p) {
    const auto new_point = static_cast<Index>(mesh_.points.size());
    mesh_.points.push_back(p);
    const auto v = mesh_.triangles[t];
    const auto n = neighbours_[t];
    const std::array<Index, 3> parts{t, new_triangle(t), new_triangle(t)};
    for (std::size_t k = 0; k < 3; ++k) {
      mesh_.triangles[parts[k]] = {v[k], v[(k + 1) % 3], new_point};
      neighbours_[parts[k]] = {n[k], parts[(k + 1) % 3], parts[(k + 2) % 3]};
      if (k > 0) replace_neighbour(n[k], t, parts[k]);
      mark(parts[k]);
    }
    flip_marked();
    return true;
  }

  /// Divides edge k of t in the middle if it is one of the air's rim.
  bool divide_rim(Index t, Index k) {
    if (!is_rim(t, k) || mesh_.tags[t] != kOutside) return false;
    const auto new_point = static_cast<Index>(mesh_.points.size());
    mesh_.points.push_back(0.5 * (corner(t, k) + corner(t, k + 1)));
    const auto v = mesh_.triangles[t];
    const auto n = neighbours_[t];
    const Index u = new_triangle(t);
    mesh_.triangles[t] = {v[k], new_point, v[(k + 2) % 3]};
    neighbours_[t] = {kNone, u, n[(k + 2) % 3]};
    mesh_.triangles[u] = {new_point, v[(k + 1) % 3], v[(k + 2) % 3]};
    neighbours_[u] = {kNone, n[(k + 1) % 3], t};
    replace_neighbour(n[(k + 1) % 3], t, u);
    mark(t);
    mark(u);
    flip_marked();
    return true;
  }

  PlaneMesh& mesh_;
  std::vector<std::array<Index, 3>> neighbours_;  // [k] lies across the edge from corner k to k + 1
  std::vector<Place> marked_;                     // edges to look at again
};

}  // namespace

void refine(PlaneMesh& mesh) { Refiner(mesh).add_points(); }

}  // namespace haptic::engine
