#include "engine/polygon.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>
#include <utility>

#include "engine/cell_builder.h"
#include "engine/delaunay.h"
#include "engine/shapes.h"

namespace haptic::engine {
namespace {

using Triangle = std::array<Index, 3>;
using glm::dvec2;

/// Nearness at which a point counts as lying on a line, as a part of the outline's size: far above rounding,
/// far below the clearance of the outline.
constexpr double kSlackRatio = 1e-9;

/// An edge longer than this many times the mean of its outline is divided.
constexpr double kLongestEdge = 4.0;

constexpr double kNever = std::numeric_limits<double>::infinity();

double cross(const dvec2& a, const dvec2& b) { return a.x * b.y - a.y * b.x; }

double distance_to_segment(const dvec2& p, const dvec2& a, const dvec2& b) {
  const dvec2 ab = b - a;
  const double t = std::clamp(glm::dot(p - a, ab) / glm::dot(ab, ab), 0.0, 1.0);
  return glm::distance(p, a + t * ab);
}

/// Whether the open segments cross, neither end lying on the other.
bool cross_each_other(const dvec2& a, const dvec2& b, const dvec2& c, const dvec2& d) {
  const auto side = [](const dvec2& from, const dvec2& to, const dvec2& p) {
    return cross(to - from, p - from) > 0.0;
  };
  return side(a, b, c) != side(a, b, d) && side(c, d, a) != side(c, d, b);
}

/// Cuts ears off a loop of points, the shortest cut first: that keeps triangles compact and no point gets a
/// long fan. The loop may pass a point twice, along a bridge to a hole.
class EarCutter {
 public:
  /// `slack` (m): points nearer than this to an ear lie in it.
  EarCutter(const std::vector<dvec2>& points, std::vector<Index> loop, double slack)
      : points_(points),
        loop_(std::move(loop)),
        slack_(slack),
        next_(loop_.size()),
        previous_(loop_.size()),
        cost_(loop_.size()) {
    for (std::size_t i = 0; i < loop_.size(); ++i) {
      next_[i] = (i + 1) % loop_.size();
      previous_[i] = (i + loop_.size() - 1) % loop_.size();
    }
  }

  std::vector<Triangle> cut() {
    std::vector<Triangle> triangles;
    update_all();
    for (std::size_t left = loop_.size(); left > 2; --left) {
      std::size_t ear = best();
      if (cost_[ear] == kNever) {  // what stood in the way may be cut off by now
        update_all();
        ear = best();
      }
      require(cost_[ear] != kNever, "outline: its points lie too nearly on a line to be cut into triangles");
      triangles.push_back(corners(ear));
      const std::size_t before = previous_[ear];
      const std::size_t after = next_[ear];
      next_[before] = after;
      previous_[after] = before;
      cost_[ear] = kNever;
      first_ = before;
      cost_[before] = cost(before);
      cost_[after] = cost(after);
    }
    return triangles;
  }

 private:
  Triangle corners(std::size_t i) const { return {loop_[previous_[i]], loop_[i], loop_[next_[i]]}; }

  void update_all() {
    std::size_t i = first_;
    do {
      cost_[i] = cost(i);
      i = next_[i];
    } while (i != first_);
  }

  std::size_t best() const {
    std::size_t best = first_;
    for (std::size_t i = next_[first_]; i != first_; i = next_[i]) {
      if (cost_[i] < cost_[best] || (cost_[i] == cost_[best] && i < best)) best = i;
    }
    return best;
  }

  /// Length of the cut, kNever if there is no ear at i.
  double cost(std::size_t i) const {
    const Triangle ear = corners(i);
    const std::array<dvec2, 3> p{points_[ear[0]], points_[ear[1]], points_[ear[2]]};
    const double length = glm::distance(p[0], p[2]);
    if (!(cross(p[1] - p[0], p[2] - p[0]) > slack_ * length)) return kNever;
    for (std::size_t other = next_[next_[i]]; other != previous_[i]; other = next_[other]) {
      const Index index = loop_[other];
      if (index == ear[0] || index == ear[1] || index == ear[2]) continue;
      bool inside = true;
      for (std::size_t k = 0; k < 3 && inside; ++k) {
        const dvec2 edge = p[(k + 1) % 3] - p[k];
        inside = cross(edge, points_[index] - p[k]) >= -slack_ * glm::length(edge);
      }
      if (inside) return kNever;
    }
    return length;
  }

  const std::vector<dvec2>& points_;
  std::vector<Index> loop_;
  double slack_;
  std::vector<std::size_t> next_, previous_;
  std::vector<double> cost_;
  std::size_t first_ = 0;
};

/// One long edge that faces many short ones would make its ends the tips of all their triangles.
std::vector<dvec2> with_long_edges_divided(std::span<const dvec2> outline) {
  double perimeter = 0.0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    perimeter += glm::distance(outline[i], outline[(i + 1) % outline.size()]);
  }
  const double longest = kLongestEdge * perimeter / static_cast<double>(outline.size());
  std::vector<dvec2> points;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const dvec2 edge = outline[(i + 1) % outline.size()] - outline[i];
    const double parts = std::max(1.0, std::ceil(glm::length(edge) / longest));
    for (double part = 0.0; part < parts; ++part) points.push_back(outline[i] + part / parts * edge);
  }
  return points;
}

/// Adds the corners of a rectangle and returns the loop around what is left of it outside the outline: along
/// the rectangle, over a bridge to the outline, clockwise around that, and back over the bridge.
std::vector<Index> loop_around(std::vector<dvec2>& points, const std::vector<Index>& outline,
                               const dvec2& low, const dvec2& high) {
  // nothing of the outline lies further right than its rightmost point, nor above it if that is the highest
  // of several: the way from there to the upper right corner is free
  const auto rightmost = std::max_element(outline.begin(), outline.end(), [&](Index a, Index b) {
    return std::pair(points[a].x, points[a].y) < std::pair(points[b].x, points[b].y);
  });
  const auto first = static_cast<Index>(points.size());
  points.insert(points.end(), {high, {low.x, high.y}, low, {high.x, low.y}});
  std::vector<Index> loop{first, first + 1, first + 2, first + 3, first};
  loop.insert(loop.end(), std::make_reverse_iterator(rightmost + 1), outline.rend());
  loop.insert(loop.end(), outline.rbegin(), std::make_reverse_iterator(rightmost));
  return loop;
}

}  // namespace

double signed_area(std::span<const dvec2> outline) {
  double twice = 0.0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    twice += cross(outline[i] - outline[0], outline[(i + 1) % outline.size()] - outline[0]);
  }
  return 0.5 * twice;
}

PlaneBox box_of(std::span<const dvec2> outline) {
  const std::size_t n = outline.size();
  require(n >= 3 && n <= kMaxOutline, "outline has ", n, " points; permitted are 3 to ", kMaxOutline);
  PlaneBox box{outline[0], outline[0]};
  for (std::size_t i = 0; i < n; ++i) {
    require(std::isfinite(outline[i].x) && std::isfinite(outline[i].y), "outline: point ", i,
            " is not finite");
    box.low = glm::min(box.low, outline[i]);
    box.high = glm::max(box.high, outline[i]);
  }
  return box;
}

void check_simple(std::span<const dvec2> outline, double clearance) {
  const std::size_t n = outline.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      require(glm::distance(outline[i], outline[j]) >= clearance, "outline: points ", j, " and ", i,
              " are at the same place");
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t end = (i + 1) % n;
    for (std::size_t j = 0; j < n; ++j) {
      if (j == i || j == end) continue;
      require(distance_to_segment(outline[j], outline[i], outline[end]) >= clearance, "outline: point ", j,
              " lies on the edge from point ", i, " to ", end);
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t end = (i + 1) % n;
    for (std::size_t j = i + 2; j < n; ++j) {
      const std::size_t other_end = (j + 1) % n;
      require(other_end == i || !cross_each_other(outline[i], outline[end], outline[j], outline[other_end]),
              "outline: the edges from point ", i, " to ", end, " and from ", j, " to ", other_end, " cross");
    }
  }
}

PlaneMesh triangulate(std::span<const dvec2> outline, double air_margin) {
  PlaneMesh mesh;
  mesh.points = with_long_edges_divided(outline);
  std::vector<Index> loop(mesh.points.size());
  std::iota(loop.begin(), loop.end(), 0U);
  if (signed_area(outline) < 0.0) std::reverse(loop.begin(), loop.end());

  const PlaneBox box = box_of(outline);
  const double slack = kSlackRatio * glm::distance(box.low, box.high);
  const auto add = [&](const std::vector<Triangle>& triangles, std::int32_t tag) {
    mesh.triangles.insert(mesh.triangles.end(), triangles.begin(), triangles.end());
    mesh.tags.resize(mesh.triangles.size(), tag);
  };
  add(EarCutter(mesh.points, loop, slack).cut(), kInside);
  if (air_margin > 0.0) {
    add(EarCutter(mesh.points, loop_around(mesh.points, loop, box.low - air_margin, box.high + air_margin),
                  slack)
            .cut(),
        kOutside);
  }
  refine(mesh);
  return mesh;
}

}  // namespace haptic::engine
