#include "drivers/phantom/phantom_protocol.h"

#include <algorithm>
#include <cmath>

namespace haptic::drivers::phantom {

RegisterMask inputs_of(const RegisterMap& map) noexcept {
  RegisterMask mask = map.button ? 1U << map.button->index : 0U;
  for (const unsigned encoder : map.encoders) mask |= 1U << encoder;
  return mask;
}

RegisterMask outputs_of(const RegisterMap& map) noexcept {
  RegisterMask mask = 0;
  for (const unsigned motor : map.motors) mask |= 1U << motor;
  return mask;
}

bool is_pressed(const RegisterMap& map, const Registers& inputs) noexcept {
  if (!map.button) return false;
  const bool is_high = (inputs[map.button->index] >> map.button->bit & 1U) != 0;
  return is_high != map.button->is_low;
}

std::int64_t counted(std::uint32_t from, std::uint32_t value, unsigned bits) noexcept {
  const std::uint64_t range = std::uint64_t{1} << bits;
  const std::uint64_t difference = (std::uint64_t{value} - from) & (range - 1);
  return difference < range / 2 ? static_cast<std::int64_t>(difference)
                                : static_cast<std::int64_t>(difference) - static_cast<std::int64_t>(range);
}

Registers words_for(const RegisterMap& map, const std::array<double, 3>& words) noexcept {
  Registers outputs = no_torque();
  double scale = 1.0;
  for (std::size_t joint = 0; joint < 3; ++joint) {
    if (!std::isfinite(words[joint])) return outputs;
    const double largest = std::min(map.largest_words[joint], kLargestWord);
    const double magnitude = std::abs(words[joint]);
    if (magnitude > largest) scale = std::min(scale, largest / magnitude);
  }
  for (std::size_t joint = 0; joint < 3; ++joint) {
    const auto word = static_cast<std::int64_t>(std::llround(scale * words[joint]));
    outputs[map.motors[joint]] = static_cast<std::uint32_t>(std::int64_t{kNoTorque} + word);
  }
  return outputs;
}

}  // namespace haptic::drivers::phantom
