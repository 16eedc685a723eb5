#pragma once
// The few functions beyond + - * / and square root that the engine needs. The C library picks its code for
// these by the processor that it finds, so that their last bits differ between machines; these are plain
// arithmetic and give the same bits everywhere. Pure and real-time safe.

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

namespace haptic::engine {

struct SinCos {
  double sine;
  double cosine;
};

/// Sine and cosine of an angle (rad), to 3e-16. An angle beyond +-kLongestAngle is cut to it, so that the
/// result is on the unit circle whatever the angle is.
SinCos sin_cos(double angle) noexcept;

/// 10 000 turns: far beyond anything that one tick can mean.
inline constexpr double kLongestAngle = 65536.0;

/// The rotation about `rotation_vector` by its length (rad): the exponential map. The zero vector gives
/// exactly the identity. Always a unit quaternion: a vector longer than 2 kLongestAngle counts as one of that
/// length, and one whose length is no finite number as zero.
glm::dquat rotation_by(const glm::dvec3& rotation_vector) noexcept;

/// What is left after a decay at unit rate for the time a >= 0, and its mean over that time.
struct Decay {
  double kept;  // exp(-a)
  double mean;  // (1 - exp(-a)) / a, 1 for a = 0
};
Decay decay(double a) noexcept;

}  // namespace haptic::engine
