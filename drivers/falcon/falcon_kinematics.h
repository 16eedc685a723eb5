#pragma once
// The geometry of a Novint Falcon: three legs from the body to the grip, each of a driven thigh and a
// parallelogram, at azimuths of 105, -15 and -135 degrees. It is a delta mechanism (Tsai; Stamper 1997) with
// a further sideways offset in each leg.
//
// Frame: origin in the middle of the body's plate, x right, y up, z out of the body towards the user; metres,
// radians. theta is the angle of a thigh out of the plate.
//
//     pu =  cos phi x + sin phi y - r          a point P seen from leg i,  U = pu + c
//     pv = -sin phi x + cos phi y - s
//     t3 = acos((pv + f) / b)                  twist of the parallelogram, k = d + e + b sin t3
//     U  = a cos t1 + k cos t2
//     z  = a sin t1 + k sin t2                 solved for t1 = theta
//
// Pure; real-time safe. Constants from libnifalcon; its Jacobian is not used, as its third column is wrong.

#include <array>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "drivers/falcon/falcon_protocol.h"

namespace haptic::drivers::falcon {

/// The angles of one leg, rad.
struct LegAngles {
  double thigh;  // t1 = theta, driven by the motor
  double shin;   // t2
  double twist;  // t3
};

/// One leg (0 to 2) with the grip at `position`; nothing if it cannot reach there.
std::optional<LegAngles> leg_angles(const glm::dvec3& position, std::size_t leg) noexcept;

/// The thighs' angles with the grip at `position`; nothing outside the workspace.
std::optional<glm::dvec3> inverse_kinematics(const glm::dvec3& position) noexcept;

/// Row i of A = d theta_i / d position, returned as column i of its transpose; rad/m. Nothing outside the
/// workspace, or where A is singular.
std::optional<glm::dmat3> transposed_jacobian(const glm::dvec3& position) noexcept;

/// Where the grip is, by Newton's method with halved steps, from `start`: the last position, or
/// kCentre. At most 20 steps; nothing if it does not come within 1e-9 rad of all three angles.
std::optional<glm::dvec3> forward_kinematics(const glm::dvec3& thighs, const glm::dvec3& start) noexcept;

/// A place in the middle of the workspace.
inline constexpr glm::dvec3 kCentre{0.0, 0.0, 0.125};

/// Angles of the thighs from encoder counts: 1280 counts a turn of the motor, a capstan of 14.25 mm on a
/// sector of 110 mm, 35 degrees at count 0 (approximate).
glm::dvec3 thigh_angles(const Words& counts) noexcept;

/// The nearest counts.
Words counts_of(const glm::dvec3& thighs) noexcept;

/// Torques at the thighs (N m) that push the user with `force` (N): tau = J^T F with J = A^-1. Nothing where
/// there is no Jacobian.
std::optional<glm::dvec3> joint_torques(const glm::dvec3& position, const glm::dvec3& force) noexcept;

/// Motor words for these torques: -gain tau, all three scaled alike if one is above kLargestWord, so that the
/// direction of the force stays. Zero if a torque is no finite number. `gain` is in words per N m;
/// libnifalcon's is 10000, found by trying and not calibrated.
Words motor_words(const glm::dvec3& torques, double gain) noexcept;

}  // namespace haptic::drivers::falcon
