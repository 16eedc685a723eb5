#pragma once
// The reports of a Razer Hydra: a base with two wands whose pose it measures magnetically, 250 times a
// second. A motion report has 52 bytes: a header of 8, not known, then 22 for each wand.
//
//     0   x, y, z, mm               3 x 16 bits, two's complement, little endian
//     6   quaternion w, x, y, z     4 x 16 bits / 32768
//     14  buttons
//     15  stick x, y                2 x 16 bits / 32768
//     19  trigger, 0 to 255
//     20  not known
//
// Its frame is left-handed; ours is its mirror image in x: (x, y, z) -> (-x, y, z), and for rotations
// (w, x, y, z) -> (w, x, -y, -z). That rotations are mirrored so is known from VRPN; that positions are
// follows from it, and waits for hardware. It starts as a gamepad; a feature report turns motion on and off.
// Pure; real-time safe.

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>

namespace haptic::drivers::hydra {

inline constexpr std::size_t kReportBytes = 52;
inline constexpr std::size_t kFeatureBytes = 91;  // with the report id, 0

struct Wand {
  glm::dvec3 position{0.0};                    // m, in the base's frame
  glm::dquat orientation{1.0, 0.0, 0.0, 0.0};  // unit
  std::uint32_t buttons = 0;  // bit 0 bumper, 1 to 4 buttons 3, 1, 2, 4, 5 middle, 6 stick; 7 trigger
};

/// Wand 0 or 1 of a motion report; nothing if the report is none, or the rotation is no rotation.
std::optional<Wand> decode(std::span<const std::uint8_t> report, std::size_t wand) noexcept;

enum class Mode : std::uint8_t { kGamepad = 0, kMotion = 3 };

/// The feature report, id first, that sets the mode.
std::array<std::uint8_t, kFeatureBytes> mode_report(Mode mode) noexcept;

}  // namespace haptic::drivers::hydra
