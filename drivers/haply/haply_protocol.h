#pragma once
// The messages of a Haply board that drives a 2DIY pantograph, over its serial port: binary, without framing,
// checksum or answer but to a request. Numbers are IEEE 754, 4 bytes, little endian; both motors and both
// encoders stand in the order of their ports, 1 and 2.
//
//     to the board     00 00                                          reset
//                      01 05, motors, encoders, sensors, PWM, floats   what is connected where
//                      02 05, torque of port 1, of port 2 (N m)       write and read
//     from the board   05, angle of port 1, of port 2 (degrees)       after each of the last kind
//
// Pure; real-time safe.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace haptic::drivers::haply {

/// How the joints are connected: joint 1 on port 2, joint 2 on port 1, in both versions.
struct Wiring {
  std::array<bool, 2> counter_clockwise;  // of ports 1 and 2
  std::array<float, 2> offset_degrees;    // of ports 1 and 2
  float counts_per_turn;
};

inline constexpr Wiring kWiring2{{false, true}, {-61.0F, 241.0F}, 10752.0F};
inline constexpr Wiring kWiring3{{true, true}, {12.0F, 168.0F}, 4880.0F};

inline constexpr std::array<std::uint8_t, 2> kReset = {0, 0};
inline constexpr std::size_t kSetupBytes = 26;
inline constexpr std::size_t kRequestBytes = 10;
inline constexpr std::size_t kReplyBytes = 9;

std::array<std::uint8_t, kSetupBytes> setup_message(const Wiring& wiring) noexcept;

/// Torques of joints 1 and 2, N m.
std::array<std::uint8_t, kRequestBytes> request_message(const std::array<double, 2>& torques) noexcept;

/// Angles of joints 1 and 2, rad; nothing if it is no reply, or an angle no finite number or beyond ten
/// turns.
std::optional<std::array<double, 2>> decode(std::span<const std::uint8_t> reply) noexcept;

}  // namespace haptic::drivers::haply
