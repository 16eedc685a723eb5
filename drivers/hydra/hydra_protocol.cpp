#include "drivers/hydra/hydra_protocol.h"

#include <cmath>

namespace haptic::drivers::hydra {

namespace {

constexpr std::size_t kHeaderBytes = 8;
constexpr std::size_t kWandBytes = 22;
constexpr double kUnit = 32768.0;
constexpr std::uint8_t kAlwaysSet = 0x80;
constexpr std::uint32_t kTriggerBit = 0x80;
constexpr std::uint8_t kTriggerPulled = 128;

// a quaternion of 16 bits is a unit one within 1e-4; what is far from it was not measured
constexpr double kShortest = 0.9;
constexpr double kLongest = 1.1;

double number_at(std::span<const std::uint8_t> bytes, std::size_t at) noexcept {
  return static_cast<std::int16_t>(static_cast<std::uint16_t>(bytes[at] | bytes[at + 1] << 8U));
}

}  // namespace

std::optional<Wand> decode(std::span<const std::uint8_t> report, std::size_t wand) noexcept {
  if (report.size() != kReportBytes || wand > 1) return std::nullopt;
  const std::span<const std::uint8_t> part = report.subspan(kHeaderBytes + wand * kWandBytes, kWandBytes);
  const glm::dquat turn(number_at(part, 6) / kUnit, number_at(part, 8) / kUnit, -number_at(part, 10) / kUnit,
                        -number_at(part, 12) / kUnit);
  const double length = glm::length(turn);
  if (!(length > kShortest && length < kLongest)) return std::nullopt;
  const std::uint32_t buttons = part[14] & static_cast<std::uint8_t>(~kAlwaysSet);
  return Wand{.position = glm::dvec3(-number_at(part, 0), number_at(part, 2), number_at(part, 4)) * 1e-3,
              .orientation = turn / length,
              .buttons = buttons | (part[19] >= kTriggerPulled ? kTriggerBit : 0U)};
}

std::array<std::uint8_t, kFeatureBytes> mode_report(Mode mode) noexcept {
  std::array<std::uint8_t, kFeatureBytes> report{};
  report[6] = 0x01;
  report[8] = 0x04;
  report[9] = static_cast<std::uint8_t>(mode);
  report[89] = static_cast<std::uint8_t>(report[6] ^ report[8] ^ report[9]);
  return report;
}

}  // namespace haptic::drivers::hydra
