#pragma once
// Polygons cut into triangles.

#include <array>
#include <cstdint>
#include <vector>

namespace haptic::view {

/// Triangles, as indices of points, that fill a simple polygon, whatever its sense; two fewer than it has
/// points. A polygon that crosses itself gives some triangles, too. Ear clipping, quadratic in the number of
/// points for shapes that one meets.
std::vector<std::array<std::uint32_t, 3>> triangulate(const std::vector<std::array<double, 2>>& outline);

}  // namespace haptic::view
