#include "engine/body.h"

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "engine/portable_math.h"

namespace haptic::engine {
namespace {

using Symmetric = std::array<std::array<double, 3>, 3>;

double density_of(const Cell& cell, std::span<const Material> materials) {
  return materials[cell.region].density;
}

// Half of a Jacobi sweep's work: turns the axes in the plane of rows p and q so that m[p][q] vanishes. The
// columns of `axes` turn along; by no more than 45 degrees, so that they stay near where they were.
void rotate_away(Symmetric& m, glm::dmat3& axes, int p, int q) {
  const auto i = static_cast<std::size_t>(p);
  const auto j = static_cast<std::size_t>(q);
  const auto k = 3 - i - j;
  const double theta = 0.5 * (m[j][j] - m[i][i]) / m[i][j];
  const double t = (theta >= 0.0 ? 1.0 : -1.0) / (std::abs(theta) + std::sqrt(theta * theta + 1.0));
  const double c = 1.0 / std::sqrt(t * t + 1.0);
  const double s = t * c;
  m[i][i] -= t * m[i][j];
  m[j][j] += t * m[i][j];
  m[i][j] = m[j][i] = 0.0;
  const double ki = c * m[k][i] - s * m[k][j];
  const double kj = s * m[k][i] + c * m[k][j];
  m[k][i] = m[i][k] = ki;
  m[k][j] = m[j][k] = kj;
  const glm::dvec3 axis_p = c * axes[p] - s * axes[q];
  axes[q] = s * axes[p] + c * axes[q];
  axes[p] = axis_p;
}

// Diagonalises m by Jacobi rotations and returns its axes as the columns of a proper rotation, in the order
// of the axes that they came from.
glm::dmat3 principal_axes(Symmetric& m) {
  // what is left of a symmetric body's products of inertia is rounding and must not turn its axes
  constexpr double kRounding = 1e-13;
  constexpr int kSweeps = 12;  // each squares the error: five are plenty
  const double small = kRounding * (m[0][0] + m[1][1] + m[2][2]);
  glm::dmat3 axes{1.0};
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (const auto& [p, q] : {std::array{0, 1}, std::array{0, 2}, std::array{1, 2}}) {
      if (std::abs(m[static_cast<std::size_t>(p)][static_cast<std::size_t>(q)]) > small) {
        rotate_away(m, axes, p, q);
      }
    }
  }
  return axes;
}

// integral of rho x x^T over a tetrahedron, x from `origin`, added to `sum`
void add_second_moment(const std::array<glm::dvec3, 4>& corners, const glm::dvec3& origin, double mass,
                       Symmetric& sum) {
  std::array<glm::dvec3, 5> x{};  // the corners and, last, their sum
  for (std::size_t i = 0; i < 4; ++i) {
    x[i] = corners[i] - origin;
    x[4] += x[i];
  }
  for (const glm::dvec3& v : x) {
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) {
        sum[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)] +=
            mass / 20.0 * v[row] * v[column];
      }
    }
  }
}

glm::dvec3 inverse_of(const glm::dvec3& inertia) noexcept {
  // an axis without inertia does not turn
  return {inertia.x > 0.0 ? 1.0 / inertia.x : 0.0, inertia.y > 0.0 ? 1.0 / inertia.y : 0.0,
          inertia.z > 0.0 ? 1.0 / inertia.z : 0.0};
}

// world from the gravity centre's axes
glm::dquat principal_orientation(const BodyDynamics& body, const BodyState& state) noexcept {
  return state.world_from_object.orientation * body.mass.object_from_gravity_centre.orientation;
}

// v after m v' = F - b v with F held for dt
glm::dvec3 next_velocity(const BodyDynamics& body, const glm::dvec3& gravity, double dt,
                         const BodyState& state) noexcept {
  const double inverse_mass = 1.0 / body.mass.mass;
  const Decay left = decay(body.linear_viscosity * dt * inverse_mass);
  return left.kept * state.velocity + (left.mean * dt) * (inverse_mass * state.applied.force + gravity);
}

// L after L' = T - c omega with T held for dt, axis by axis in the principal frame
glm::dvec3 next_angular_momentum(const BodyDynamics& body, double dt, const BodyState& state) noexcept {
  if (body.angular_viscosity == 0.0) return state.angular_momentum + dt * state.applied.torque;
  const glm::dvec3 rate = body.angular_viscosity * dt * inverse_of(body.mass.inertia);
  const glm::dquat world_from_principal = principal_orientation(body, state);
  const glm::dquat principal_from_world = glm::conjugate(world_from_principal);
  const glm::dvec3 torque = principal_from_world * state.applied.torque;
  glm::dvec3 momentum = principal_from_world * state.angular_momentum;
  for (int axis = 0; axis < 3; ++axis) {
    const Decay left = decay(rate[axis]);
    momentum[axis] = left.kept * momentum[axis] + left.mean * dt * torque[axis];
  }
  return world_from_principal * momentum;
}

// The turn of one tick as a rotation vector in the principal frame: dt times the angular velocity half way,
// which the turn itself defines. `momentum` is L in the principal frame at the start.
glm::dvec3 midpoint_turn(const glm::dvec3& inertia, const glm::dvec3& momentum, double dt) noexcept {
  constexpr int kFixedPointSteps = 4;  // each gains a factor |turn|/2: 1e-8 at 30 rad/s and 1 ms
  const glm::dvec3 dt_over_inertia = dt * inverse_of(inertia);
  glm::dvec3 turn = dt_over_inertia * momentum;
  for (int i = 0; i < kFixedPointSteps; ++i) {
    turn = dt_over_inertia * (glm::conjugate(rotation_by(0.5 * turn)) * momentum);
  }
  return turn;
}

// orientation of the object after the tick
glm::dquat next_orientation(const BodyDynamics& body, const glm::dvec3& angular_momentum, double dt,
                            const BodyState& state) noexcept {
  const glm::dquat& orientation = state.world_from_object.orientation;
  const glm::dvec3 momentum = glm::conjugate(principal_orientation(body, state)) * angular_momentum;
  const glm::dvec3 turn = midpoint_turn(body.mass.inertia, momentum, dt);
  // a body at rest keeps its orientation to the bit
  if (turn == glm::dvec3{0.0}) return orientation;
  return glm::normalize(orientation * rotation_by(body.mass.object_from_gravity_centre.orientation * turn));
}

bool is_finite(const glm::dvec3& v) noexcept {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool is_finite(const glm::dquat& q) noexcept {
  return std::isfinite(q.w) && std::isfinite(q.x) && std::isfinite(q.y) && std::isfinite(q.z);
}

}  // namespace

MassProperties mass_properties(const CellComplex& cells, std::span<const Material> materials) {
  const auto corners_of = [&](const Cell& cell) {
    std::array<glm::dvec3, 4> corners;
    for (std::size_t i = 0; i < 4; ++i) corners[i] = cells.vertices()[cell.vertices[i]];
    return corners;
  };
  const auto mass_of = [&](const Cell& cell, const std::array<glm::dvec3, 4>& v) {
    return density_of(cell, materials) * glm::dot(v[1] - v[0], glm::cross(v[2] - v[0], v[3] - v[0])) / 6.0;
  };

  // from a corner of the body itself, so that one far from its origin loses nothing
  const glm::dvec3 near = cells.bounds().low;
  MassProperties result;
  glm::dvec3 first_moment{0.0};
  for (const Cell& cell : cells.cells()) {
    const auto v = corners_of(cell);
    const double mass = mass_of(cell, v);
    result.mass += mass;
    first_moment += 0.25 * mass * ((v[0] - near) + (v[1] - near) + (v[2] - near) + (v[3] - near));
  }
  if (!(result.mass > 0.0)) return {};
  const glm::dvec3 centre = near + first_moment / result.mass;

  Symmetric second_moment{};
  for (const Cell& cell : cells.cells()) {
    const auto v = corners_of(cell);
    add_second_moment(v, centre, mass_of(cell, v), second_moment);
  }
  const glm::dmat3 axes = principal_axes(second_moment);
  result.object_from_gravity_centre = {centre, glm::normalize(glm::quat_cast(axes))};
  const glm::dvec3 spread{second_moment[0][0], second_moment[1][1], second_moment[2][2]};
  result.inertia = {spread.y + spread.z, spread.z + spread.x, spread.x + spread.y};
  return result;
}

glm::dvec3 angular_velocity(const BodyDynamics& body, const BodyState& state) noexcept {
  const glm::dquat world_from_principal = principal_orientation(body, state);
  return world_from_principal *
         (inverse_of(body.mass.inertia) * (glm::conjugate(world_from_principal) * state.angular_momentum));
}

void integrate(const BodyDynamics& body, const glm::dvec3& gravity, double dt, BodyState& state) noexcept {
  const Pose& pose = state.world_from_object;
  const glm::dvec3& centre = body.mass.object_from_gravity_centre.position;
  BodyState next = state;
  next.velocity = next_velocity(body, gravity, dt, state);
  next.angular_momentum = next_angular_momentum(body, dt, state);
  next.world_from_object.orientation = next_orientation(body, next.angular_momentum, dt, state);
  // the centre of gravity moves by the velocity, and the object's origin swings about it
  const glm::dvec3 swing = pose.orientation * centre - next.world_from_object.orientation * centre;
  next.world_from_object.position = pose.position + dt * next.velocity + swing;

  if (is_finite(next.velocity) && is_finite(angular_velocity(body, next)) &&
      is_finite(next.angular_momentum) && is_finite(next.world_from_object.position) &&
      is_finite(next.world_from_object.orientation)) {
    state = next;
  } else {
    state.velocity = state.angular_momentum = glm::dvec3{0.0};
  }
}

}  // namespace haptic::engine
