#include "drivers/haply/haply_kinematics.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace haptic::drivers::haply {

namespace {

// rods that stand closer to one line than this (as a share of L) pass forces on without bound
constexpr double kSmallestAngle = 0.05;

struct Elbows {
  glm::dvec2 a;
  glm::dvec2 b;
};

Elbows elbows(const Geometry& geometry, const std::array<double, 2>& angles) noexcept {
  return {geometry.arm * glm::dvec2(std::cos(angles[0]), std::sin(angles[0])),
          glm::dvec2(geometry.distance, 0.0) +
              geometry.arm * glm::dvec2(std::cos(angles[1]), std::sin(angles[1]))};
}

double cross(const glm::dvec2& u, const glm::dvec2& v) noexcept { return u.x * v.y - u.y * v.x; }

}  // namespace

std::optional<glm::dvec2> handle_position(const Geometry& geometry,
                                          const std::array<double, 2>& angles) noexcept {
  const Elbows at = elbows(geometry, angles);
  const glm::dvec2 between = at.b - at.a;
  const double length = glm::length(between);
  const double height = geometry.rod * geometry.rod - length * length / 4.0;
  const double least = kSmallestAngle * geometry.rod;
  if (!(length > least) || !(height > least * least)) return std::nullopt;
  const glm::dvec2 left(-between.y / length, between.x / length);
  return at.a + 0.5 * between + std::sqrt(height) * left;
}

std::optional<std::array<double, 2>> arm_torques(const Geometry& geometry,
                                                 const std::array<double, 2>& angles,
                                                 const glm::dvec2& force) noexcept {
  const std::optional<glm::dvec2> handle = handle_position(geometry, angles);
  if (!handle) return std::nullopt;
  const Elbows at = elbows(geometry, angles);
  const glm::dvec2 rod_a = *handle - at.a;
  const glm::dvec2 rod_b = *handle - at.b;

  // rods keep their length: rod_a . dP = rod_a . dA, rod_b . dP = rod_b . dB. The force is carried by both
  // rods, F = u rod_a + v rod_b, and each turns its own arm
  const double area = cross(rod_a, rod_b);
  const double u = cross(force, rod_b) / area;
  const double v = cross(rod_a, force) / area;
  const glm::dvec2 turn_a = geometry.arm * glm::dvec2(-std::sin(angles[0]), std::cos(angles[0]));  // dA / dt1
  const glm::dvec2 turn_b = geometry.arm * glm::dvec2(-std::sin(angles[1]), std::cos(angles[1]));
  const std::array<double, 2> torques = {u * glm::dot(rod_a, turn_a), v * glm::dot(rod_b, turn_b)};
  if (!std::isfinite(torques[0]) || !std::isfinite(torques[1])) return std::nullopt;
  return torques;
}

}  // namespace haptic::drivers::haply
