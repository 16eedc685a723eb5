#pragma once
// A path in time: where a device, or the hand that holds it, is at each moment. Rows come from a CSV file
// (load/path_file.h) or from a test; sampling them is pure, allocates nothing and is real-time safe.
//
//    position
//      |        o-------          straight between rows, the first and the last row hold for ever,
//      |       /                  or the path starts again at its end (repeat)
//      | -----o
//      +------|-|------> time

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <span>

namespace haptic::drivers {

/// One row of a path.
struct PathPoint {
  double time = 0.0;                           // s from the start of the device; ascends from row to row
  glm::dvec3 position{0.0, 0.0, 0.0};          // m, world
  glm::dquat orientation{1.0, 0.0, 0.0, 0.0};  // world_from_device, unit
};

/// Where a path is at one moment.
struct PathSample {
  glm::dvec3 position{0.0, 0.0, 0.0};          // m, world
  glm::dquat orientation{1.0, 0.0, 0.0, 0.0};  // world_from_device, unit
  glm::dvec3 velocity{0.0, 0.0, 0.0};          // m/s; zero where an end holds
};

/// The path at `time` (s): positions are joined by straight lines, orientations by the shorter arc (slerp).
/// On a row the velocity is that of the interval that begins there. With `repeat` the path starts again at
/// the time of its last row, which then never shows. `path` ascends strictly in time; an empty one rests at
/// the origin. Real-time safe.
PathSample sample(std::span<const PathPoint> path, double time, bool repeat) noexcept;

}  // namespace haptic::drivers
