#include "engine/finger.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "engine/constants.h"
#include "engine/portable_math.h"

namespace haptic::engine {
namespace {

// a turn divided by the golden ratio squared: the angle between neighbours on the spiral of a sunflower
constexpr double kGoldenAngle = 2.39996322972865332223;

// orthonormal: the pole, and two axes across it that are the same for the opposite pole
struct CapAxes {
  glm::dvec3 across, along, pole;
};

CapAxes axes_of(const glm::dvec3& direction) {
  // scaled first, so that the length neither overflows nor vanishes
  const double largest = std::max({std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)});
  const glm::dvec3 pole = glm::normalize(direction / largest);
  // from the coordinate axis least aligned with the pole, the first of equals
  const glm::dvec3 size = glm::abs(pole);
  const int least = size.x <= size.y && size.x <= size.z ? 0 : (size.y <= size.z ? 1 : 2);
  glm::dvec3 across = -pole[least] * pole;
  across[least] += 1.0;
  across = glm::normalize(across);
  // right-handed about a pole whose next coordinate is positive, left-handed about its opposite
  glm::dvec3 along = glm::cross(pole, across);
  const double next = pole[(least + 1) % 3];
  if (next < 0.0 || (next == 0.0 && pole[(least + 2) % 3] < 0.0)) along = -along;
  return {across, along, pole};
}

}  // namespace

std::vector<glm::dvec3> point_layout() { return {glm::dvec3{0.0, 0.0, 0.0}}; }

std::vector<glm::dvec3> line_layout(const glm::dvec3& start, const glm::dvec3& end, int hips) {
  std::vector<glm::dvec3> points;
  if (hips == 1) return {0.5 * start + 0.5 * end};
  for (int i = 0; i < hips; ++i) {
    // weighted from both ends: the last point is the end itself
    const double share = static_cast<double>(i) / (hips - 1);
    points.push_back((1.0 - share) * start + share * end);
  }
  return points;
}

std::vector<glm::dvec3> fingertip_layout(double radius, double cap_angle, int hips,
                                         const glm::dvec3& direction) {
  const CapAxes axes = axes_of(direction);
  const double height = 1.0 - sin_cos(cap_angle).cosine;  // of the cap, in radii
  std::vector<glm::dvec3> points{radius * axes.pole};
  for (int i = 1; i < hips; ++i) {
    // areas of a sphere are as heights: each HIP has the middle of 1/hips of the cap's height
    const double depth = height * (i + 0.5) / hips;
    const double ring = std::sqrt(std::max(0.0, depth * (2.0 - depth)));
    const SinCos turn = sin_cos(kGoldenAngle * i);
    points.push_back(
        radius * ((1.0 - depth) * axes.pole + ring * (turn.cosine * axes.across + turn.sine * axes.along)));
  }
  return points;
}

bool is_usable(const FingerPose& finger) noexcept {
  const glm::dvec3& p = finger.world_from_device.position;
  const glm::dquat& q = finger.world_from_device.orientation;
  const double norm = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
  // written so that NaN fails
  return finger.present && std::abs(p.x) <= kWorldReach && std::abs(p.y) <= kWorldReach &&
         std::abs(p.z) <= kWorldReach && std::abs(norm - 1.0) <= kUnitTolerance;
}

Wrench sum_wrench(std::span<const glm::dvec3> hip_positions, std::span<const glm::dvec3> hip_forces,
                  const glm::dvec3& origin) noexcept {
  Wrench sum;
  for (std::size_t i = 0; i < hip_positions.size(); ++i) {
    sum.force += hip_forces[i];
    sum.torque += glm::cross(hip_positions[i] - origin, hip_forces[i]);
  }
  return sum;
}

}  // namespace haptic::engine
