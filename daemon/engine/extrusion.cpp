// cylinder_mesh and extrusion_mesh: a plane mesh, carried along z through three slabs (air, shape, air).

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <numeric>

#include "engine/cell_builder.h"
#include "engine/polygon.h"
#include "engine/portable_math.h"
#include "engine/shapes.h"

namespace haptic::engine {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr int kMaxSegments = 4096;

TetraMesh extrude(const PlaneMesh& plane, double height, double air_margin) {
  std::vector<double> levels{-0.5 * height, 0.5 * height};
  if (air_margin > 0.0)
    levels = {-0.5 * height - air_margin, levels[0], levels[1], 0.5 * height + air_margin};

  TetraMesh mesh;
  for (const double z : levels) {
    for (const glm::dvec2& p : plane.points) mesh.vertices.emplace_back(p.x, p.y, z);
  }
  const std::size_t shape_slab = levels.size() / 2 - 1;
  for (std::size_t slab = 0; slab + 1 < levels.size(); ++slab) {
    const auto bottom = static_cast<Index>(slab * plane.points.size());
    const auto top = static_cast<Index>((slab + 1) * plane.points.size());
    for (std::size_t t = 0; t < plane.triangles.size(); ++t) {
      const auto& [a, b, c] = plane.triangles[t];
      add_prism(mesh, {bottom + a, bottom + b, bottom + c}, {top + a, top + b, top + c},
                slab == shape_slab ? plane.tags[t] : kOutside);
    }
  }
  return mesh;
}

/// Rings of points around the origin, with triangles between them.
class Disc {
 public:
  struct Ring {
    Index first;
    std::vector<Index> steps;  // its points, as multiples of a full turn over `segments`
    double radius;
  };

  explicit Disc(int segments) : segments_(segments) {}

  Ring add_ring(std::vector<Index> steps, double radius) {
    Ring ring{static_cast<Index>(plane_.points.size()), std::move(steps), radius};
    for (const Index step : ring.steps) {
      const SinCos angle = sin_cos(2.0 * kPi * step / segments_);
      plane_.points.emplace_back(radius * angle.cosine, radius * angle.sine);
    }
    return ring;
  }

  /// A ring of every second point of another.
  Ring add_coarser(const Ring& ring, double radius) {
    std::vector<Index> steps;
    for (std::size_t i = 0; i < ring.steps.size(); i += 2) steps.push_back(ring.steps[i]);
    return add_ring(std::move(steps), radius);
  }

  /// Triangles between a ring and one with the same points, or with every second, at another radius.
  void fill_between(const Ring& fine, const Ring& coarse, std::int32_t tag) {
    const std::size_t n = fine.steps.size();
    const std::size_t stride = coarse.steps.size() == n ? 1 : 2;
    for (std::size_t i = 0; i < n; i += stride) {
      const Index here = coarse.first + static_cast<Index>(i / stride);
      const Index next = coarse.first + static_cast<Index>(i / stride + 1) % size(coarse);
      const Index start = fine.first + static_cast<Index>(i);
      const Index middle = fine.first + static_cast<Index>(i + 1) % size(fine);
      add({start, middle, here}, tag);
      add({middle, next, here}, tag);
      // an odd ring has one single step at its end
      if (stride == 2 && i + 1 < n)
        add({middle, fine.first + static_cast<Index>(i + 2) % size(fine), next}, tag);
    }
  }

  /// Cuts what a ring encloses by joining every second point, again and again.
  void fill_middle(const Ring& ring, std::int32_t tag) {
    std::vector<Index> loop(ring.steps.size());
    std::iota(loop.begin(), loop.end(), ring.first);
    while (loop.size() > 2) {
      std::vector<Index> rest;
      for (std::size_t i = 0; i < loop.size(); i += 2) {
        rest.push_back(loop[i]);
        if (i + 1 < loop.size() && loop.size() > 3)
          add({loop[i], loop[i + 1], loop[(i + 2) % loop.size()]}, tag);
      }
      if (loop.size() == 3) {
        add({loop[0], loop[1], loop[2]}, tag);
        return;
      }
      loop = std::move(rest);
    }
  }

  PlaneMesh take() { return std::move(plane_); }

 private:
  static Index size(const Ring& ring) { return static_cast<Index>(ring.steps.size()); }

  void add(const std::array<Index, 3>& triangle, std::int32_t tag) {
    plane_.triangles.push_back(triangle);
    plane_.tags.push_back(tag);
  }

  int segments_;
  PlaneMesh plane_;
};

/// Thickness of the band between a ring and the next coarser one, over its radius: some two thirds of an
/// edge.
double band(const Disc::Ring& ring) { return 4.0 / static_cast<double>(ring.steps.size()); }

/// The disc of a cylinder: rings that grow coarser from the surface, inward and outward.
PlaneMesh disc(double radius, int segments, double air_margin) {
  constexpr std::size_t kInnermost = 6;  // points of a ring that is filled without further rings
  constexpr std::size_t kOutermost =
      24;  // points below which the air would lose more than 1/100 to the corners
  Disc disc(segments);
  std::vector<Index> all(static_cast<std::size_t>(segments));
  std::iota(all.begin(), all.end(), 0U);
  const Disc::Ring surface = disc.add_ring(std::move(all), radius);

  Disc::Ring ring = surface;
  while (ring.steps.size() > kInnermost) {
    const Disc::Ring inner = disc.add_coarser(ring, ring.radius * (1.0 - band(ring)));
    disc.fill_between(ring, inner, kInside);
    ring = inner;
  }
  disc.fill_middle(ring, kInside);
  if (air_margin == 0.0) return disc.take();

  ring = surface;
  const double last = radius + air_margin;
  while (ring.steps.size() >= 2 * kOutermost && ring.radius * (1.0 + 2.0 * band(ring)) < last) {
    const Disc::Ring outer = disc.add_coarser(ring, ring.radius * (1.0 + band(ring)));
    disc.fill_between(ring, outer, kOutside);
    ring = outer;
  }
  const Disc::Ring rim = disc.add_ring(ring.steps, last);
  disc.fill_between(ring, rim, kOutside);
  return disc.take();
}

}  // namespace

TetraMesh cylinder_mesh(double radius, double height, int segments, double air_margin) {
  require(segments >= 3 && segments <= kMaxSegments, "segments is ", segments, "; permitted are 3 to ",
          kMaxSegments);
  const std::array<Length, 3> lengths{
      {{"radius", radius}, {"height", height}, {"the length of a segment", 2.0 * kPi * radius / segments}}};
  require_lengths(lengths);
  require_margin(air_margin, std::max(radius, height));
  return extrude(disc(radius, segments, air_margin), height, air_margin);
}

TetraMesh extrusion_mesh(std::span<const glm::dvec2> outline, double height, double air_margin) {
  const PlaneBox box = box_of(outline);
  const double size = glm::distance(box.low, box.high);
  const std::array<Length, 2> lengths{{{"the size of the outline", size}, {"height", height}}};
  require_lengths(lengths);
  require_margin(air_margin, std::max(size, height));
  check_simple(outline, kSmallestRatio * std::max({size, height, air_margin}));
  return extrude(triangulate(outline, air_margin), height, air_margin);
}

}  // namespace haptic::engine
