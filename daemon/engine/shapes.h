#pragma once
// Shapes cut into cells: inside cells (tag kInside), and around them a layer of outside cells (tag kOutside)
// that conforms to the surface, so that a HIP is held before it touches. The object frame has its origin at
// the shape's centre (that of an extrusion is where its outline has it). All lengths in m. Nothing here is
// real-time safe; each throws std::invalid_argument naming the parameter.
//
// Lengths must be finite and positive, and none may be below a millionth of the largest; `air_margin` may be
// 0, which leaves the outside away. Cells are about as thick as wide where the shape permits, they grow
// coarser away from a fine surface, and no vertex or edge belongs to very many of them.

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>

#include "engine/cell_complex.h"

namespace haptic::engine {

inline constexpr std::int32_t kOutside = 0;
inline constexpr std::int32_t kInside = 1;

/// A box with edges along the axes: 6 inside cells under 12 triangles. The outside ends at a box that is
/// `air_margin` away on every side.
TetraMesh box_mesh(const glm::dvec3& size, double air_margin);

/// A sphere of 20 * 4^subdivisions triangles (0 to 7) with its vertices at `radius`. The outside ends at an
/// icosphere of the same or fewer subdivisions with its vertices at radius + air_margin, and is nowhere
/// thinner than nine tenths of the margin (three quarters below two subdivisions).
TetraMesh icosphere_mesh(double radius, int subdivisions, double air_margin);

/// A cylinder along z of `segments` (3 to 4096) sides, with its edges at `radius`. The outside ends at a
/// prism whose edges are at radius + air_margin, of the same number of sides or, for 48 segments and more, of
/// fewer (at least 24), and `air_margin` above and below.
TetraMesh cylinder_mesh(double radius, double height, int segments, double air_margin);

/// A polygon in the xy plane of 3 to 4096 points, simple, convex or not, in either sense, extruded along z
/// from -height/2 to height/2. Points on a straight edge are permitted; a point that touches or comes nearer
/// than a millionth of the shape's size to an edge that it does not end is not. The outside ends at the box
/// around the extrusion that is `air_margin` away on every side.
TetraMesh extrusion_mesh(std::span<const glm::dvec2> outline, double height, double air_margin);

}  // namespace haptic::engine
