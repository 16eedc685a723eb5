#pragma once
// The geometry of arms of the WoodenHaptics family: a turntable A carries two links B and C, each turned by a
// motor at the base through a capstan.
//
//     theta_i = s_i 2 pi count_i / cpr_i * capstan_i / body_i
//     R = Lb sin B + Lc sin C
//     x = R cos A - x0,  y = R sin A - y0,  z = Ln + Lb cos B - Lc cos C - z0
//
// Frame: z up, x out of the base towards the user at A = 0, its origin in the middle of the workspace;
// metres, radians. Polhem v2 and v3 have a closed loop of links, whose geometry is not published, and are not
// among the models. Numbers from haptikfabrikenapi. Pure; real-time safe.

#include <array>
#include <glm/vec3.hpp>

#include "drivers/polhem/polhem_protocol.h"

namespace haptic::drivers::polhem {

struct Model {
  std::array<double, 3> capstan;          // diameter, m
  std::array<double, 3> body;             // diameter, m
  double column;                          // Ln, m
  double link_b;                          // Lb, m
  double link_c;                          // Lc, m
  glm::dvec3 origin;                      // x0, y0, z0, m
  std::array<double, 3> torque_constant;  // N m/A
  double counts_per_turn;
};

extern const Model kWoodenhaptics2019;
extern const Model kWoodenhaptics2015;
extern const Model kAluhapticsV2;
extern const Model kVintage;

/// Angles A, B, C (rad).
glm::dvec3 joint_angles(const Model& model, const Joints& counts) noexcept;

/// Of the tool's tip, m.
glm::dvec3 tip_position(const Model& model, const glm::dvec3& angles) noexcept;

/// Torques at the joints (N m) that push the user with `force` (N).
glm::dvec3 joint_torques(const Model& model, const glm::dvec3& angles, const glm::dvec3& force) noexcept;

/// Currents (mA) for these torques, all scaled alike if one is above `max_current` (A), so that the direction
/// of the force stays. Zero if a torque is no finite number.
Joints motor_currents(const Model& model, const glm::dvec3& torques, double max_current) noexcept;

}  // namespace haptic::drivers::polhem
