#pragma once
// What the registers of a PHANToM's card say, by the calibration of one device: which encoder, motor and
// button is where is published for no model. Counts from a counter of some bits that wraps; words of a motor
// as the card's converters take them, 12 bits with 2048 for no torque.
//
// Pure; real-time safe.

#include <array>
#include <cstdint>
#include <optional>

#include "drivers/io/phantom/phantom_card.h"

namespace haptic::drivers::phantom {

using io::RegisterMask;
using io::Registers;

/// The word of no torque.
inline constexpr std::uint32_t kNoTorque = 2048;
/// By which a word may differ from it at the most.
inline constexpr std::uint32_t kLargestWord = 2047;

/// One bit of one input register.
struct Button {
  unsigned index = 6;
  unsigned bit = 1;
  bool is_low = false;  // pressed, the bit is 0
};

/// Where things are.
struct RegisterMap {
  std::array<unsigned, 3> encoders{};                            // input registers: base, upper arm, forearm
  std::array<unsigned, 3> encoder_bits{16, 16, 16};              // 8 to 32, from the lowest
  std::array<unsigned, 3> motors{};                              // output registers
  std::array<std::uint32_t, 3> largest_words{1024, 1024, 1024};  // up to kLargestWord
  std::optional<Button> button{};
};

/// Input registers that are looked at, and no others.
RegisterMask inputs_of(const RegisterMap& map) noexcept;
/// Output registers of the motors.
RegisterMask outputs_of(const RegisterMap& map) noexcept;

/// False without a button.
bool is_pressed(const RegisterMap& map, const Registers& inputs) noexcept;

/// `value` - `from` for a counter of `bits` bits that may have wrapped: the smallest such difference.
std::int64_t counted(std::uint32_t from, std::uint32_t value, unsigned bits) noexcept;

/// Outputs for these motor words (torque in words, signed). One that is too large scales all three: the
/// direction of a force stays. All of no torque if one is no finite number.
Registers words_for(const RegisterMap& map, const std::array<double, 3>& words) noexcept;

/// Outputs of no torque.
inline Registers no_torque() noexcept {
  Registers outputs{};
  outputs.fill(kNoTorque);
  return outputs;
}

}  // namespace haptic::drivers::phantom
