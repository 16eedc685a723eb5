#pragma once
// Binary records as a FASTRAK sends them.

#include <array>
#include <cstdint>
#include <cstring>
#include <vector>

namespace haptic::drivers::fastrak {

/// Place in cm, quaternion w, x, y, z.
inline std::vector<std::uint8_t> record_of(int station, const std::array<float, 3>& place,
                                           const std::array<float, 4>& turn = {1, 0, 0, 0},
                                           char error = ' ') {
  std::vector<std::uint8_t> bytes = {'0', static_cast<std::uint8_t>('0' + station),
                                     static_cast<std::uint8_t>(error)};
  const auto add = [&](float value) {
    std::array<std::uint8_t, 4> raw{};
    std::memcpy(raw.data(), &value, 4);
    bytes.insert(bytes.end(), raw.begin(), raw.end());
  };
  for (const float value : place) add(value);
  for (const float value : turn) add(value);
  bytes.push_back(' ');
  return bytes;
}

}  // namespace haptic::drivers::fastrak
