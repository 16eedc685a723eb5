#pragma once
// Motion reports as a Hydra's base sends them.

#include <array>
#include <cstdint>
#include <vector>

namespace haptic::drivers::hydra {

struct WandReport {
  std::array<int, 3> millimetres{};
  std::array<int, 4> quaternion{32767, 0, 0, 0};  // w, x, y, z of 32768
  std::uint8_t buttons = 0x80;                    // the highest is always set
  std::uint8_t trigger = 0;
};

inline std::vector<std::uint8_t> motion_report(const WandReport& left, const WandReport& right) {
  std::vector<std::uint8_t> bytes(8, 0xEE);
  const auto word = [&](int value) {
    bytes.push_back(static_cast<std::uint8_t>(value & 0xFF));
    bytes.push_back(static_cast<std::uint8_t>((value >> 8) & 0xFF));
  };
  for (const WandReport& wand : {left, right}) {
    for (const int value : wand.millimetres) word(value);
    for (const int value : wand.quaternion) word(value);
    bytes.push_back(wand.buttons);
    word(0);
    word(0);
    bytes.push_back(wand.trigger);
    word(0);
  }
  return bytes;
}

}  // namespace haptic::drivers::hydra
