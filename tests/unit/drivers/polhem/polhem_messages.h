#pragma once
// Messages as an arm sends and reads them.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace haptic::drivers::polhem {

inline std::vector<std::uint8_t> words(std::initializer_list<int> values) {
  std::vector<std::uint8_t> bytes;
  for (const int value : values) {
    bytes.push_back(static_cast<std::uint8_t>(value & 0xFF));
    bytes.push_back(static_cast<std::uint8_t>((value >> 8) & 0xFF));
  }
  return bytes;
}

inline int word_of(std::span<const std::uint8_t> bytes, std::size_t word) {
  const int value = bytes[2 * word] + 256 * bytes[2 * word + 1];
  return value >= 0x8000 ? value - 0x10000 : value;
}

inline std::vector<std::uint8_t> datagram(int a, int b, int c) {
  std::vector<std::uint8_t> bytes = {0xA4, 0x17, 0x42};
  const std::vector<std::uint8_t> counts = words({a, b, c, 0, 0, 0, 12, 34});
  bytes.insert(bytes.end(), counts.begin(), counts.end());
  bytes.push_back(0x99);
  return bytes;
}

}  // namespace haptic::drivers::polhem
