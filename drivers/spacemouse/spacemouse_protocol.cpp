#include "drivers/spacemouse/spacemouse_protocol.h"

#include <algorithm>
#include <cstddef>

namespace haptic::drivers::spacemouse {

namespace {

// the range of the report descriptor; real pucks go some way beyond
constexpr double kFullDeflection = 350.0;

constexpr std::uint8_t kFirst = 1;
constexpr std::uint8_t kSecond = 2;
constexpr std::uint8_t kButtonsId = 3;
constexpr std::size_t kSplitBytes = 7;
constexpr std::size_t kCombinedBytes = 13;

glm::dvec3 axes_at(std::span<const std::uint8_t> report, std::size_t first) noexcept {
  glm::dvec3 axes(0.0);
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t at = first + 2 * static_cast<std::size_t>(axis);
    const auto raw = static_cast<std::int16_t>(static_cast<std::uint16_t>(report[at] | report[at + 1] << 8U));
    axes[axis] = std::clamp(raw / kFullDeflection, -1.0, 1.0);
  }
  return axes;
}

}  // namespace

Report Decoder::take(std::span<const std::uint8_t> report) noexcept {
  if (report.empty()) return Report::kUnknown;
  if (report[0] == kFirst && report.size() >= kCombinedBytes) {
    deflection_ = {axes_at(report, 1), axes_at(report, 7)};
    return Report::kMotion;
  }
  if (report[0] == kFirst && report.size() >= kSplitBytes) {
    deflection_.translation = axes_at(report, 1);
    return Report::kMotion;
  }
  if (report[0] == kSecond && report.size() >= kSplitBytes) {
    deflection_.rotation = axes_at(report, 1);
    return Report::kMotion;
  }
  if (report[0] == kButtonsId && report.size() >= 2) {
    buttons_ = 0;
    for (std::size_t i = 1; i < std::min<std::size_t>(report.size(), 5); ++i) {
      buttons_ |= static_cast<std::uint32_t>(report[i]) << (8 * (i - 1));
    }
    return Report::kButtons;
  }
  return Report::kUnknown;
}

}  // namespace haptic::drivers::spacemouse
