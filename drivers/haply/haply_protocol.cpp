#include "drivers/haply/haply_protocol.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace haptic::drivers::haply {

namespace {

constexpr std::uint8_t kSetup = 1;
constexpr std::uint8_t kWriteAndRead = 2;
constexpr std::uint8_t kDevice = 5;
constexpr std::uint8_t kPorts1And2 = 0b11;
constexpr double kMostDegrees = 3600.0;
constexpr double kDegree = std::numbers::pi / 180.0;

void put(std::span<std::uint8_t> bytes, std::size_t at, float value) noexcept {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<std::uint8_t>((bits >> (8 * i)) & 0xFFU);
}

float get(std::span<const std::uint8_t> bytes, std::size_t at) noexcept {
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < 4; ++i) bits |= static_cast<std::uint32_t>(bytes[at + i]) << (8 * i);
  return std::bit_cast<float>(bits);
}

}  // namespace

std::array<std::uint8_t, kSetupBytes> setup_message(const Wiring& wiring) noexcept {
  std::array<std::uint8_t, kSetupBytes> bytes{kSetup, kDevice};
  // a mask and two directions for the motors, the same for the encoders, then neither sensors nor PWM
  for (const std::size_t block : {2U, 5U}) {
    bytes[block] = kPorts1And2;
    for (std::size_t port = 0; port < 2; ++port)
      bytes[block + 1 + port] = wiring.counter_clockwise[port] ? 1 : 0;
  }
  for (std::size_t port = 0; port < 2; ++port) {
    put(bytes, 10 + 8 * port, wiring.offset_degrees[port]);
    put(bytes, 14 + 8 * port, wiring.counts_per_turn);
  }
  return bytes;
}

std::array<std::uint8_t, kRequestBytes> request_message(const std::array<double, 2>& torques) noexcept {
  std::array<std::uint8_t, kRequestBytes> bytes{kWriteAndRead, kDevice};
  put(bytes, 2, static_cast<float>(torques[1]));
  put(bytes, 6, static_cast<float>(torques[0]));
  return bytes;
}

std::optional<std::array<double, 2>> decode(std::span<const std::uint8_t> reply) noexcept {
  if (reply.size() != kReplyBytes || reply[0] != kDevice) return std::nullopt;
  const std::array<double, 2> degrees = {get(reply, 5), get(reply, 1)};
  const bool is_sound = std::all_of(degrees.begin(), degrees.end(),
                                    [](double angle) { return std::abs(angle) <= kMostDegrees; });
  if (!is_sound) return std::nullopt;
  return std::array<double, 2>{degrees[0] * kDegree, degrees[1] * kDegree};
}

}  // namespace haptic::drivers::haply
