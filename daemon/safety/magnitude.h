#pragma once
// Lengths and finiteness of vectors that may hold anything. Pure, real-time safe.

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

namespace haptic::safety {

inline bool is_finite(const glm::dvec3& v) noexcept {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

inline bool is_finite(const glm::dquat& q) noexcept {
  return std::isfinite(q.w) && std::isfinite(q.x) && std::isfinite(q.y) && std::isfinite(q.z);
}

inline double largest_component(const glm::dvec3& v) noexcept {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

/// Length without overflow on the way; infinite only if the length itself is beyond a double.
inline double length(const glm::dvec3& v) noexcept {
  const double largest = largest_component(v);
  if (largest == 0.0) return 0.0;
  const glm::dvec3 scaled = v / largest;
  return largest * std::sqrt(scaled.x * scaled.x + scaled.y * scaled.y + scaled.z * scaled.z);
}

/// `v` brought down to `limit` in its own direction if it is longer; `scale` is what it was multiplied by.
inline glm::dvec3 clamp_length(const glm::dvec3& v, double limit, double& scale) noexcept {
  scale = 1.0;
  if (length(v) <= limit) return v;
  const double largest = largest_component(v);
  const glm::dvec3 scaled = v / largest;
  const double unit = limit / length(scaled);
  scale = unit / largest;
  return scaled * unit;
}

}  // namespace haptic::safety
