#pragma once
// Rigid bodies (paper section 3.3): mass properties from cells and densities, and the equations of Newton and
// Euler in the gravity-centre frame, whose axes are the principal axes of inertia.

#include <glm/vec3.hpp>
#include <span>

#include "engine/cell_complex.h"
#include "engine/material.h"
#include "engine/pose.h"

namespace haptic::engine {

/// What the cells and their densities make of an object. The gravity-centre frame has its origin at the
/// centre of gravity and its axes along the principal axes of inertia.
struct MassProperties {
  double mass = 0.0;                  // kg
  Pose object_from_gravity_centre;    // m
  glm::dvec3 inertia{0.0, 0.0, 0.0};  // principal moments, kg m^2
};

/// Integrates the cells: the inertia of a tetrahedron is rho V / 20 (sum x_i x_i^T + S S^T) with S = sum x_i.
/// Cells of density 0 (air) count nothing. Mass 0 if nothing has a density. Not real-time safe.
MassProperties mass_properties(const CellComplex& cells, std::span<const Material> materials);

/// How an object moves. A fixed object has mass 0 here and is never integrated.
struct BodyDynamics {
  MassProperties mass;
  double linear_viscosity = 0.0;   // N s/m
  double angular_viscosity = 0.0;  // N m s/rad
};

/// Everything of a body that a tick changes.
struct BodyState {
  Pose world_from_object;
  glm::dvec3 velocity{0.0, 0.0, 0.0};          // of the centre of gravity, m/s, world
  glm::dvec3 angular_momentum{0.0, 0.0, 0.0};  // about the centre of gravity, kg m^2/s, world
  Wrench applied;  // by HIPs at this instant: N, and N m about the centre of gravity, world
};

/// Angular velocity (rad/s, world).
glm::dvec3 angular_velocity(const BodyDynamics& body, const BodyState& state) noexcept;

/// Centre of gravity (m, world).
inline glm::dvec3 centre_of_gravity(const BodyDynamics& body, const BodyState& state) noexcept {
  return state.world_from_object * body.mass.object_from_gravity_centre.position;
}

/// Carries the body dt seconds on under `state.applied` and gravity (m/s^2, world).
/// Velocity follows the exact solution of m v' = F - b v for a force held over the tick; position moves by
/// the NEW velocity. Angular momentum L takes the torque and the viscosity the same way in the principal
/// axes, and orientation follows L by the Lie midpoint rule (gyroscopic term included): torque-free, L is
/// conserved to the bit and energy has no drift. Needs body.mass.mass > 0; an axis without inertia does not
/// turn. A body that would leave the range of a double stops where it is: no NaN comes of finite input.
/// Real-time safe.
void integrate(const BodyDynamics& body, const glm::dvec3& gravity, double dt, BodyState& state) noexcept;

}  // namespace haptic::engine
