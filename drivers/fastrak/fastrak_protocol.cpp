#include "drivers/fastrak/fastrak_protocol.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace haptic::drivers::fastrak {

namespace {

constexpr double kCentimetre = 0.01;
// m: the tracker reaches 3 m, with an extended range a little more
constexpr double kFurthest = 10.0;
constexpr double kShortest = 0.99;
constexpr double kLongest = 1.01;

float number_at(const std::array<std::uint8_t, kRecordBytes>& bytes, std::size_t at) noexcept {
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < 4; ++i) bits |= static_cast<std::uint32_t>(bytes[at + i]) << (8 * i);
  return std::bit_cast<float>(bits);
}

/// Whether a record can begin with these bytes.
bool can_begin(const std::uint8_t* bytes, std::size_t length) noexcept {
  if (length > 0 && bytes[0] != '0') return false;
  if (length > 1 && (bytes[1] < '1' || bytes[1] > '4')) return false;
  if (length <= 2) return true;
  const std::uint8_t error = bytes[2];
  return error == ' ' || (error >= 'A' && error <= 'Z') || (error >= 'a' && error <= 'z');
}

bool decode(const std::array<std::uint8_t, kRecordBytes>& bytes, Record& record) noexcept {
  if (bytes.back() != ' ') return false;
  const glm::dvec3 position(number_at(bytes, 3), number_at(bytes, 7), number_at(bytes, 11));
  const glm::dquat turn(number_at(bytes, 15), number_at(bytes, 19), number_at(bytes, 23),
                        number_at(bytes, 27));
  for (int axis = 0; axis < 3; ++axis) {
    if (!(std::abs(position[axis]) * kCentimetre <= kFurthest)) return false;
  }
  const double length = glm::length(turn);
  if (!(length >= kShortest && length <= kLongest)) return false;
  record = {.station = bytes[1] - '0',
            .error = static_cast<char>(bytes[2]),
            .position = kCentimetre * position,
            .orientation = turn / length};
  return true;
}

}  // namespace

bool RecordParser::take(std::uint8_t byte, Record& record) noexcept {
  bytes_[length_++] = byte;
  if (length_ == kRecordBytes && decode(bytes_, record)) {
    length_ = 0;
    return true;
  }
  // drop bytes from the front until what is left may be the beginning of a record
  std::size_t dropped = length_ == kRecordBytes ? 1 : 0;
  while (dropped < length_ && !can_begin(bytes_.data() + dropped, length_ - dropped)) ++dropped;
  if (dropped > 0) {
    std::copy(bytes_.begin() + static_cast<std::ptrdiff_t>(dropped),
              bytes_.begin() + static_cast<std::ptrdiff_t>(length_), bytes_.begin());
    length_ -= dropped;
  }
  return false;
}

bool is_status(const std::vector<std::uint8_t>& bytes) noexcept {
  constexpr std::size_t kShortestStatus = 54;
  return bytes.size() >= kShortestStatus && bytes[0] == '2' && bytes[2] == 'S' &&
         bytes[bytes.size() - 2] == '\r' && bytes.back() == '\n';
}

std::vector<std::string> start_commands(int station, const glm::dvec3& hemisphere) {
  return {fmt::format("l{},1\r", station),
          fmt::format("O{},2,11,0\r", station),
          fmt::format("H{},{:.3f},{:.3f},{:.3f}\r", station, hemisphere.x, hemisphere.y, hemisphere.z),
          "x0,1,0,0\r",  // filters would lag
          "v0,1,0,0\r",
          "u",
          "f",
          "C"};
}

}  // namespace haptic::drivers::fastrak
