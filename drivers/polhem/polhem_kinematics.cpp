#include "drivers/polhem/polhem_kinematics.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace haptic::drivers::polhem {

// in none of these models are motor and body aligned: every s_i is +1
const Model kWoodenhaptics2019{.capstan = {0.010, 0.010, 0.010},
                               .body = {0.160, 0.120, 0.120},
                               .column = 0.080,
                               .link_b = 0.205,
                               .link_c = 0.245,
                               .origin = {0.220, 0.0, 0.080},
                               .torque_constant = {0.321, 0.0603, 0.0603},
                               .counts_per_turn = 2000.0};

const Model kWoodenhaptics2015{.capstan = {0.010, 0.010, 0.010},
                               .body = {0.160, 0.120, 0.120},
                               .column = 0.080,
                               .link_b = 0.205,
                               .link_c = 0.245,
                               .origin = {0.220, 0.0, 0.080},
                               .torque_constant = {0.0259, 0.0259, 0.0259},
                               .counts_per_turn = 2000.0};

const Model kAluhapticsV2{.capstan = {0.0138, 0.0098, 0.0098},
                          .body = {0.116, 0.076, 0.076},
                          .column = 0.111,
                          .link_b = 0.140,
                          .link_c = 0.111,
                          .origin = {0.140, 0.0, 0.0},
                          .torque_constant = {0.0259, 0.0259, 0.0259},
                          .counts_per_turn = 2000.0};

const Model kVintage{.capstan = {0.013, 0.010, 0.010},
                     .body = {0.117, 0.077, 0.077},
                     .column = 0.056,
                     .link_b = 0.138,
                     .link_c = 0.112,
                     .origin = {0.140, 0.0, 0.0},
                     .torque_constant = {0.0163, 0.0163, 0.0163},
                     .counts_per_turn = 4000.0};

glm::dvec3 joint_angles(const Model& model, const Joints& counts) noexcept {
  glm::dvec3 angles(0.0);
  for (std::size_t i = 0; i < 3; ++i) {
    const double turns = counts[i] / model.counts_per_turn;
    angles[static_cast<int>(i)] = 2.0 * std::numbers::pi * turns * model.capstan[i] / model.body[i];
  }
  return angles;
}

glm::dvec3 tip_position(const Model& model, const glm::dvec3& angles) noexcept {
  const double reach = model.link_b * std::sin(angles.y) + model.link_c * std::sin(angles.z);
  const double height = model.column + model.link_b * std::cos(angles.y) - model.link_c * std::cos(angles.z);
  return glm::dvec3(reach * std::cos(angles.x), reach * std::sin(angles.x), height) - model.origin;
}

glm::dvec3 joint_torques(const Model& model, const glm::dvec3& angles, const glm::dvec3& force) noexcept {
  const double reach = model.link_b * std::sin(angles.y) + model.link_c * std::sin(angles.z);
  const double outward = std::cos(angles.x) * force.x + std::sin(angles.x) * force.y;
  const double sideways = -std::sin(angles.x) * force.x + std::cos(angles.x) * force.y;
  return {reach * sideways, model.link_b * (std::cos(angles.y) * outward - std::sin(angles.y) * force.z),
          model.link_c * (std::cos(angles.z) * outward + std::sin(angles.z) * force.z)};
}

Joints motor_currents(const Model& model, const glm::dvec3& torques, double max_current) noexcept {
  std::array<double, 3> amperes{};
  double largest = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    amperes[i] = torques[static_cast<int>(i)] * model.capstan[i] / model.body[i] / model.torque_constant[i];
    if (!std::isfinite(amperes[i])) return {};
    largest = std::max(largest, std::abs(amperes[i]));
  }
  const double scale = largest > max_current ? max_current / largest : 1.0;
  Joints milliamperes{};
  for (std::size_t i = 0; i < 3; ++i) {
    milliamperes[i] = static_cast<std::int16_t>(std::lround(1000.0 * scale * amperes[i]));
  }
  return milliamperes;
}

}  // namespace haptic::drivers::polhem
