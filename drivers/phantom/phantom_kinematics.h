#pragma once
// The geometry of a PHANToM Premium: a base that turns about the vertical, an upper arm and a forearm whose
// motors both stand on the base, so that the angle of each is its own.
//
//     side view, all angles 0          x = r sin base
//                                      y = l1 sin upper + l2 (1 - cos fore)
//     base o-----------o elbow         z = r cos base - l1
//          |    l1     |               r = l1 cos upper + l2 sin fore, from the axis of the base
//                      | l2
//                      + finger: the origin; x right, y up, z towards the user
//
// Positive angles turn to the right, lift the elbow, and swing the finger towards the user. Pure; real-time
// safe. The geometry is that of M. C. Cavusoglu, D. Feygin, F. Tendick, "A Critical Study of the Mechanical
// and Electrical Properties of the PHANToM Haptic Interface", Presence 11(6), 2002.

#include <glm/vec3.hpp>

namespace haptic::drivers::phantom {

/// Lengths of the arms, m.
struct Geometry {
  double upper_arm = 0.0;
  double forearm = 0.0;
};

/// Where the finger is (m) with these angles of base, upper arm and forearm (rad).
glm::dvec3 finger_position(const Geometry& geometry, const glm::dvec3& angles) noexcept;

/// Torques at the joints (N m, towards greater angles) that push the user with `force` (N): J^T F.
glm::dvec3 joint_torques(const Geometry& geometry, const glm::dvec3& angles,
                         const glm::dvec3& force) noexcept;

}  // namespace haptic::drivers::phantom
