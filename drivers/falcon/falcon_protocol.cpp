#include "drivers/falcon/falcon_protocol.h"

#include <algorithm>

namespace haptic::drivers::falcon {

namespace {

constexpr std::uint8_t kStart = '<';
constexpr std::uint8_t kEnd = '>';
constexpr std::uint8_t kZero = 0x41;

constexpr std::size_t kFlags = 13;
constexpr std::size_t kUnknown = 14;

/// Whether `byte` can stand at place `at` of a reply that has begun.
bool fits(std::size_t at, std::uint8_t byte) noexcept {
  if (byte == kStart) return false;
  if (at < kFlags) return byte >= kZero && byte < kZero + 16;
  if (at == kFlags) return byte >= kZero && byte < kZero + 128;
  return at == kUnknown || byte == kEnd;
}

std::int16_t word_at(const Packet& packet, std::size_t first) noexcept {
  unsigned value = 0;
  for (std::size_t nibble = 0; nibble < 4; ++nibble) {
    value |= static_cast<unsigned>(packet[first + nibble] - kZero) << (4 * nibble);
  }
  return static_cast<std::int16_t>(static_cast<std::uint16_t>(value));
}

}  // namespace

Packet encode(const Request& request) noexcept {
  Packet packet;
  packet.front() = kStart;
  for (std::size_t motor = 0; motor < 3; ++motor) {
    const std::int16_t largest = kLargestWord;
    const std::int16_t word = std::clamp<std::int16_t>(request.motors[motor], -largest, largest);
    const unsigned value = static_cast<std::uint16_t>(word);
    for (std::size_t nibble = 0; nibble < 4; ++nibble) {
      packet[1 + 4 * motor + nibble] = static_cast<std::uint8_t>(kZero + ((value >> (4 * nibble)) & 15U));
    }
  }
  const unsigned flags = (request.homing ? 1U : 0U) | static_cast<unsigned>(request.led);
  packet[kFlags] = static_cast<std::uint8_t>(kZero + flags);
  packet[kUnknown] = kZero;
  packet.back() = kEnd;
  return packet;
}

bool ReplyParser::take(std::uint8_t byte, Reply& reply) noexcept {
  if (length_ == 0 || !fits(length_, byte)) {
    skipped_ += length_;
    length_ = 0;
    if (byte != kStart) {
      ++skipped_;
      return false;
    }
  }
  packet_[length_++] = byte;
  if (length_ < kPacketBytes) return false;
  length_ = 0;
  for (std::size_t leg = 0; leg < 3; ++leg) reply.counts[leg] = word_at(packet_, 1 + 4 * leg);
  const unsigned flags = packet_[kFlags] - kZero;
  reply.buttons = static_cast<std::uint8_t>(flags & 15U);
  reply.homed = static_cast<std::uint8_t>(flags >> 4U);
  return true;
}

}  // namespace haptic::drivers::falcon
