#pragma once
// A pantograph: two driven arms of length l on axes a distance d apart, two rods of length L from their ends
// to the handle.
//
//              P                 A = (l cos t1, l sin t1),  B = (d + l cos t2, l sin t2)
//            /   \ L             P = where circles of radius L about A and B meet, on the left of A -> B
//          A       B
//         l \     / l            frame: x along the axes, y away from the board; metres, radians
//            +-d-+
//
// Pure; real-time safe.

#include <array>
#include <glm/vec2.hpp>
#include <optional>

namespace haptic::drivers::haply {

struct Geometry {
  double arm;       // l, m
  double rod;       // L, m
  double distance;  // d, m
};

inline constexpr Geometry kGeometry2{0.07, 0.09, 0.0};
inline constexpr Geometry kGeometry3{0.07, 0.09, 0.038};

/// The handle's place with the arms at these angles; nothing where the rods do not meet, or lie in one line.
std::optional<glm::dvec2> handle_position(const Geometry& geometry,
                                          const std::array<double, 2>& angles) noexcept;

/// Torques at the arms (N m) that push the user with `force` (N); nothing where the handle has no place, or
/// no torque holds a force.
std::optional<std::array<double, 2>> arm_torques(const Geometry& geometry,
                                                 const std::array<double, 2>& angles,
                                                 const glm::dvec2& force) noexcept;

}  // namespace haptic::drivers::haply
