#pragma once
// Triangles in the plane, for shapes that are extruded from it.

#include <array>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "engine/cell_complex.h"

namespace haptic::engine {

/// A conforming triangulation; every point belongs to a triangle.
struct PlaneMesh {
  std::vector<glm::dvec2> points;  // m
  std::vector<std::array<Index, 3>> triangles;
  std::vector<std::int32_t> tags;  // kInside or kOutside, one for each triangle
};

/// Points that an outline may have: its edges are compared pair by pair.
inline constexpr std::size_t kMaxOutline = 4096;

struct PlaneBox {
  glm::dvec2 low, high;  // m
};

/// The rectangle around an outline. Throws std::invalid_argument unless it has 3 to kMaxOutline points, all
/// finite.
PlaneBox box_of(std::span<const glm::dvec2> outline);

/// Throws std::invalid_argument unless the outline is a simple polygon that keeps clear of itself: no point
/// may lie on, or nearer than `clearance` (m) to, another point or an edge that it does not end.
void check_simple(std::span<const glm::dvec2> outline, double clearance);

/// Positive for a counter-clockwise outline, m^2.
double signed_area(std::span<const glm::dvec2> outline);

/// Cuts the inside of a simple outline into triangles, and with air_margin > 0 also what lies between it and
/// the rectangle around it at that distance. Edges much longer than the mean are divided; all others stay
/// whole.
PlaneMesh triangulate(std::span<const glm::dvec2> outline, double air_margin);

}  // namespace haptic::engine
