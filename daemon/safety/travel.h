#pragma once
// Where a device may be while it is given force: a box in its own frame. Near the end of its travel geometry
// is badly conditioned, and a force may press against a stop. Pure, real-time safe.

#include <algorithm>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>

namespace haptic::safety {

/// Its sides belong to it; unlimited by default. Empty if a min is above its max: then every place is beyond.
struct TravelBox {
  glm::dvec3 min{-std::numeric_limits<double>::infinity()};  // m
  glm::dvec3 max{std::numeric_limits<double>::infinity()};   // m
};

inline TravelBox intersection(const TravelBox& a, const TravelBox& b) noexcept {
  return {glm::max(a.min, b.min), glm::min(a.max, b.max)};
}

/// A coordinate (m) that is beyond its side of the box.
struct OverTravel {
  double coordinate;
  double side;
};

/// Of a place (m, the device's own frame) beyond the box: the coordinate that is the furthest beyond.
inline std::optional<OverTravel> over_travel(const TravelBox& box, const glm::dvec3& place) noexcept {
  std::optional<OverTravel> worst;
  double furthest = 0.0;
  for (glm::length_t axis = 0; axis < 3; ++axis) {
    const bool is_below = place[axis] < box.min[axis];
    const double side = is_below ? box.min[axis] : box.max[axis];
    const double beyond = is_below ? side - place[axis] : place[axis] - side;
    if (beyond <= furthest) continue;
    furthest = beyond;
    worst = OverTravel{place[axis], side};
  }
  return worst;
}

}  // namespace haptic::safety
