#include "drivers/falcon/falcon_kinematics.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/matrix.hpp>
#include <numbers>

namespace haptic::drivers::falcon {

namespace {

constexpr double kThigh = 0.060;             // a
constexpr double kShin = 0.1025;             // b
constexpr double kGripOffset = 0.01443;      // c
constexpr double kEndLinks = 2.0 * 0.01125;  // d + e
constexpr double kSideOffset = -0.025;       // f
constexpr double kBaseRadius = 0.0400;       // r
constexpr double kBaseSide = -0.02309;       // s

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kThighAtZero = 35.0 * kDegree;
constexpr double kRadiansPerCount = 14.25 / 110.0 * 2.0 * std::numbers::pi / 1280.0;

constexpr int kMostSteps = 20;
constexpr int kMostHalvings = 12;
constexpr double kTolerance = 1e-9;  // rad: a count is 6e-4

// |det A| is above 3e3 rad^3/m^3 in all of the workspace; near 0 a force would ask for endless torque
constexpr double kSmallestDeterminant = 1.0;

struct Azimuth {
  double cosine;
  double sine;
};

Azimuth azimuth(double degrees) { return {std::cos(degrees * kDegree), std::sin(degrees * kDegree)}; }

const std::array<Azimuth, 3> kLegs = {azimuth(105.0), azimuth(-15.0), azimuth(-135.0)};

bool is_finite(const glm::dvec3& v) noexcept {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

double largest(const glm::dvec3& v) noexcept {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

}  // namespace

std::optional<LegAngles> leg_angles(const glm::dvec3& position, std::size_t leg) noexcept {
  const Azimuth phi = kLegs[leg];
  const double across = -phi.sine * position.x + phi.cosine * position.y - kBaseSide + kSideOffset;
  const double out = phi.cosine * position.x + phi.sine * position.y - kBaseRadius + kGripOffset;  // U
  if (!(std::abs(across) <= kShin)) return std::nullopt;
  const double twist = std::acos(across / kShin);
  const double reach = kEndLinks + kShin * std::sin(twist);  // k

  // tangent of half the angle of the thigh: l2 T^2 + l1 T + l0 = 0
  const double sum = position.z * position.z + out * out + kThigh * kThigh - reach * reach;
  const double l0 = sum - 2.0 * kThigh * out;
  const double l1 = -4.0 * kThigh * position.z;
  const double l2 = sum + 2.0 * kThigh * out;
  const double discriminant = l1 * l1 - 4.0 * l0 * l2;
  if (!(discriminant >= 0.0) || l2 == 0.0) return std::nullopt;
  const double thigh = 2.0 * std::atan((-l1 - std::sqrt(discriminant)) / (2.0 * l2));

  const double along = (out - kThigh * std::cos(thigh)) / reach;
  if (!(std::abs(along) <= 1.0)) return std::nullopt;
  return LegAngles{.thigh = thigh, .shin = std::acos(along), .twist = twist};
}

std::optional<glm::dvec3> inverse_kinematics(const glm::dvec3& position) noexcept {
  glm::dvec3 thighs(0.0);
  for (std::size_t leg = 0; leg < 3; ++leg) {
    const std::optional<LegAngles> angles = leg_angles(position, leg);
    if (!angles) return std::nullopt;
    thighs[static_cast<glm::length_t>(leg)] = angles->thigh;
  }
  return thighs;
}

std::optional<glm::dmat3> transposed_jacobian(const glm::dvec3& position) noexcept {
  glm::dmat3 rows(0.0);
  for (std::size_t leg = 0; leg < 3; ++leg) {
    const std::optional<LegAngles> angles = leg_angles(position, leg);
    if (!angles) return std::nullopt;
    const Azimuth phi = kLegs[leg];
    const double sin_twist = std::sin(angles->twist);
    const double cos_twist = std::cos(angles->twist);
    const double along = std::cos(angles->shin) * sin_twist;
    const glm::dvec3 row(phi.cosine * along - phi.sine * cos_twist, phi.sine * along + phi.cosine * cos_twist,
                         std::sin(angles->shin) * sin_twist);
    rows[static_cast<glm::length_t>(leg)] =
        row / (kThigh * sin_twist * std::sin(angles->shin - angles->thigh));
  }
  const double determinant = glm::determinant(rows);
  if (!std::isfinite(determinant) || std::abs(determinant) < kSmallestDeterminant) return std::nullopt;
  return rows;
}

std::optional<glm::dvec3> forward_kinematics(const glm::dvec3& thighs, const glm::dvec3& start) noexcept {
  glm::dvec3 position = start;
  std::optional<glm::dvec3> reached = inverse_kinematics(position);
  if (!reached || !is_finite(thighs)) return std::nullopt;
  for (int step = 0; step < kMostSteps; ++step) {
    const glm::dvec3 error = thighs - *reached;
    if (largest(error) < kTolerance) return position;
    const std::optional<glm::dmat3> rows = transposed_jacobian(position);
    if (!rows) return std::nullopt;
    glm::dvec3 delta = glm::inverse(glm::transpose(*rows)) * error;

    // the whole step may leave the workspace or overshoot: half of it, and again
    bool is_nearer = false;
    for (int halving = 0; halving <= kMostHalvings && !is_nearer; ++halving, delta *= 0.5) {
      const std::optional<glm::dvec3> there = inverse_kinematics(position + delta);
      if (!there || !(largest(thighs - *there) < largest(error))) continue;
      position += delta;
      reached = there;
      is_nearer = true;
    }
    if (!is_nearer) return std::nullopt;
  }
  return std::nullopt;
}

glm::dvec3 thigh_angles(const Words& counts) noexcept {
  return glm::dvec3(kThighAtZero) + kRadiansPerCount * glm::dvec3(counts[0], counts[1], counts[2]);
}

Words counts_of(const glm::dvec3& thighs) noexcept {
  Words counts{};
  for (std::size_t leg = 0; leg < 3; ++leg) {
    const double exact = (thighs[static_cast<glm::length_t>(leg)] - kThighAtZero) / kRadiansPerCount;
    counts[leg] = static_cast<std::int16_t>(std::lround(std::clamp(exact, -32768.0, 32767.0)));
  }
  return counts;
}

std::optional<glm::dvec3> joint_torques(const glm::dvec3& position, const glm::dvec3& force) noexcept {
  const std::optional<glm::dmat3> rows = transposed_jacobian(position);
  if (!rows) return std::nullopt;
  return glm::inverse(*rows) * force;  // J^T = (A^-1)^T = (A^T)^-1
}

Words motor_words(const glm::dvec3& torques, double gain) noexcept {
  glm::dvec3 words = -gain * torques;
  const double most = largest(words);
  if (!is_finite(words)) return {};
  if (most > kLargestWord) words *= kLargestWord / most;
  return {static_cast<std::int16_t>(std::lround(words.x)), static_cast<std::int16_t>(std::lround(words.y)),
          static_cast<std::int16_t>(std::lround(words.z))};
}

}  // namespace haptic::drivers::falcon
