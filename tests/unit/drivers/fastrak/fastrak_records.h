#pragma once
// Binary records as Polhemus trackers send them.

#include <array>
#include <cstdint>
#include <cstring>
#include <vector>

namespace haptic::drivers::fastrak {

/// Place in cm, quaternion w, x, y, z.
inline std::vector<std::uint8_t> record_of(int station, const std::array<float, 3>& place,
                                           const std::array<float, 4>& turn = {1, 0, 0, 0},
                                           char error = ' ') {
  std::vector<std::uint8_t> bytes(3 + sizeof place + sizeof turn + 1, ' ');
  bytes[0] = '0';
  bytes[1] = static_cast<std::uint8_t>('0' + station);
  bytes[2] = static_cast<std::uint8_t>(error);
  std::memcpy(&bytes[3], place.data(), sizeof place);
  std::memcpy(&bytes[3 + sizeof place], turn.data(), sizeof turn);
  return bytes;
}

/// Likewise of a Liberty ("LY"), a Latus ("LU") or a Patriot ("PA").
inline std::vector<std::uint8_t> liberty_record_of(char first, char second, int station,
                                                   const std::array<float, 3>& place,
                                                   const std::array<float, 4>& turn = {1, 0, 0, 0},
                                                   char error = ' ') {
  std::vector<std::uint8_t> bytes = {static_cast<std::uint8_t>(first),
                                     static_cast<std::uint8_t>(second),
                                     static_cast<std::uint8_t>(station),
                                     'C',
                                     static_cast<std::uint8_t>(error),
                                     0,
                                     29,
                                     0};
  const std::vector<std::uint8_t> body = record_of(1, place, turn);
  bytes.insert(bytes.end(), body.begin() + 3, body.end());
  return bytes;
}

}  // namespace haptic::drivers::fastrak
