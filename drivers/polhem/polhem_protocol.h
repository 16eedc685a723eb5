#pragma once
// The messages of arms of the WoodenHaptics family. All numbers are 16 bits, two's complement, little endian.
//
//     USB HID, no report ids, 14 bytes or padded to 64:
//       from the arm   counts a b c d e f, info              info 1: its calibration button was pressed
//       to the arm     current a b c (mA), command, 3 more   command 0: these currents; 1: preset the
//       counters
//     UDP, from the arm, 20 bytes:
//       A4 17 42, counts a b c d e f, 2 bytes of time, 2 of number, a checksum that nobody describes
//
// Counts a, b, c are of the driven joints. The arm waits for an answer to each report, and takes its currents
// away if none comes for half a second. Pure; real-time safe.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace haptic::drivers::polhem {

inline constexpr std::size_t kMessageBytes = 14;
inline constexpr std::size_t kDatagramBytes = 20;

using Joints = std::array<std::int16_t, 3>;

struct Reading {
  Joints counts{};
  bool calibrate = false;  // the button

  friend bool operator==(const Reading&, const Reading&) = default;
};

/// Nothing if there are fewer bytes than a message has.
std::optional<Reading> decode_report(std::span<const std::uint8_t> report) noexcept;

/// Nothing if it is no datagram of an arm.
std::optional<Reading> decode_datagram(std::span<const std::uint8_t> datagram) noexcept;

using Message = std::array<std::uint8_t, kMessageBytes>;

/// Asks for these currents, mA.
Message currents_message(const Joints& milliamperes) noexcept;

/// Sets the counters of the driven joints to these counts, and all others to 0.
Message preset_message(const Joints& counts) noexcept;

}  // namespace haptic::drivers::polhem
