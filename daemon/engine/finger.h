#pragma once
// Fingers: HIPs that ride on one device (paper section 3.2). A point contact can give no torque about its
// normal; many HIPs spread over a fingertip can. Each HIP is constrained on its own, and their forces are
// summed for the device.

#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

#include "engine/pose.h"

namespace haptic::engine {

/// One HIP at the device's origin.
std::vector<glm::dvec3> point_layout();

/// `hips` (>= 1) HIPs evenly spread from start to end, both included; one HIP stands at the middle. m, device
/// frame.
std::vector<glm::dvec3> line_layout(const glm::dvec3& start, const glm::dvec3& end, int hips);

/// `hips` (>= 1) points spread evenly over a spherical cap around the device's origin: the first at the pole,
/// the rest on a spiral outward of which each has an equal share of the cap's area and is a golden angle
/// (137.5 degrees) on from the one before, as seeds are in a sunflower. Opposite directions give mirror
/// images: two fingertips that face each other press on opposite points. `radius` in m, `cap_angle` the half
/// angle of the cap (rad, 0 to pi), `direction` that of the pole (not zero).
std::vector<glm::dvec3> fingertip_layout(double radius, double cap_angle, int hips,
                                         const glm::dvec3& direction);

/// HIPs that ride on one device.
struct Finger {
  std::string name;
  std::string device;
  double stiffness = 0.0;        // N/m of each HIP
  std::vector<glm::dvec3> hips;  // m, device frame
  std::size_t first_hip = 0;     // its first HIP among all of the scene
};

/// Where a finger is in this tick.
struct FingerPose {
  Pose world_from_device;
  bool present = false;  // false: no sample; its HIPs feel nothing and touch nothing
};

/// Whether a present finger's pose can be meant: finite, within kWorldReach, and its quaternion a rotation.
/// Real-time safe.
bool is_usable(const FingerPose& finger) noexcept;

/// The wrench of HIP forces about the device's origin (world frame; N, N m). Real-time safe.
Wrench sum_wrench(std::span<const glm::dvec3> hip_positions, std::span<const glm::dvec3> hip_forces,
                  const glm::dvec3& origin) noexcept;

}  // namespace haptic::engine
