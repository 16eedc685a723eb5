#pragma once
// The bytes that a Novint Falcon with running firmware exchanges: 16 in each direction, strictly request and
// reply. A byte of payload is 0x41 + value; a number is 16 bits in two's complement, in four such bytes of
// four bits each, the lowest first.
//
//            0   1..4    5..8    9..12     13                         14  15
//     out   '<'  motor 1 motor 2 motor 3   homing, green, blue, red   A   '>'
//     in    '<'  count 1 count 2 count 3   4 buttons, homed 1 2 3     ?   '>'
//
// Pure; real-time safe. Facts from the sources of libnifalcon and from arithmetic on them; byte 14 of a reply
// is not known and not looked at.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace haptic::drivers::falcon {

inline constexpr std::size_t kPacketBytes = 16;
using Packet = std::array<std::uint8_t, kPacketBytes>;

/// Words for the three motors, or counts of the three encoders; leg 1 is the upper one, then clockwise as the
/// user sees it.
using Words = std::array<std::int16_t, 3>;

/// The largest magnitude that a motor word may have.
inline constexpr std::int16_t kLargestWord = 4095;

enum class Led : std::uint8_t { kOff = 0, kGreen = 2, kBlue = 4, kRed = 8 };

/// What the host asks for. A positive word drives its joint towards a smaller count.
struct Request {
  Words motors{};  // clamped to kLargestWord
  bool homing = true;
  Led led = Led::kOff;
};

/// What the device answers.
struct Reply {
  Words counts{};
  std::uint8_t buttons = 0;  // bit 0 plus, 1 forward, 2 centre, 3 minus
  std::uint8_t homed = 0;    // bit n: encoder n + 1 has passed its mark

  friend bool operator==(const Reply&, const Reply&) = default;
};

inline constexpr std::uint8_t kAllHomed = 7;

Packet encode(const Request& request) noexcept;

/// Finds replies in a stream that may be split anywhere and hold anything. '<' occurs nowhere but at the
/// start of a packet, so one that is broken costs no other.
class ReplyParser {
 public:
  /// One more byte. True if it completes a reply, which `reply` then holds.
  bool take(std::uint8_t byte, Reply& reply) noexcept;

  /// Bytes that were part of no reply.
  std::uint64_t skipped() const noexcept { return skipped_; }

  /// Forgets a reply that is not complete.
  void reset() noexcept { length_ = 0; }

 private:
  Packet packet_{};
  std::size_t length_ = 0;  // 0: waits for '<'
  std::uint64_t skipped_ = 0;
};

}  // namespace haptic::drivers::falcon
