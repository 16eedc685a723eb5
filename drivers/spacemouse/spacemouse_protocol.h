#pragma once
// The reports of 3Dconnexion's 6-DoF mice. A report begins with its id; numbers are 16 bits, two's
// complement, little endian.
//
//     1, 7 bytes      translation x, y, z             models that split a pose
//     2, 7 bytes      rotation about x, y, z
//     1, 13 bytes     translation, then rotation      models that combine it
//     3, 2 to 5       buttons, lowest bit first
//
// Which of the two a model sends is told by the length alone. Other ids (battery) are passed over. Pure;
// real-time safe.

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>

namespace haptic::drivers::spacemouse {

/// How far the puck is pushed and turned: 1 is full deflection in each axis, and no axis is beyond it.
struct Deflection {
  glm::dvec3 translation{0.0};
  glm::dvec3 rotation{0.0};

  bool is_zero() const noexcept { return translation == glm::dvec3(0.0) && rotation == glm::dvec3(0.0); }
};

enum class Report { kUnknown, kMotion, kButtons };

/// What the reports so far have told.
class Decoder {
 public:
  /// A report as it was read. One that is too short changes nothing and is kUnknown.
  Report take(std::span<const std::uint8_t> report) noexcept;

  const Deflection& deflection() const noexcept { return deflection_; }
  std::uint32_t buttons() const noexcept { return buttons_; }

 private:
  Deflection deflection_;
  std::uint32_t buttons_ = 0;
};

}  // namespace haptic::drivers::spacemouse
