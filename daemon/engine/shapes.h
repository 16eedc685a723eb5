#pragma once
// Shapes cut into cells: inside cells (tag kInside), and around them a layer of outside cells (tag kOutside)
// that conforms to the surface, so that a HIP is held before it touches. The object frame has its origin at
// the shape's centre. All lengths in m. Nothing here is real-time safe; each throws std::invalid_argument
// naming the parameter.

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>

#include "engine/cell_complex.h"

namespace haptic::engine {

inline constexpr std::int32_t kOutside = 0;
inline constexpr std::int32_t kInside = 1;

/// A box with edges along the axes. `air_margin` is the thickness of the outside layer; 0 leaves it away.
TetraMesh box_mesh(const glm::dvec3& size, double air_margin);

/// A sphere of 20 * 4^subdivisions triangles (0 to 6) with its vertices at `radius`. The inside is made of
/// shells that grow coarser inward, so that no vertex belongs to very many cells.
TetraMesh icosphere_mesh(double radius, int subdivisions, double air_margin);

/// A cylinder along z of `segments` (>= 3) sides.
TetraMesh cylinder_mesh(double radius, double height, int segments, double air_margin);

/// A polygon in the xy plane, simple, convex or not, in either sense, extruded along z from -height/2 to
/// height/2.
TetraMesh extrusion_mesh(std::span<const glm::dvec2> outline, double height, double air_margin);

}  // namespace haptic::engine
