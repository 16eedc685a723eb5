#pragma once
// A made-up PHANToM: arms of 0.2 and 0.15 m, 1000 counts for a radian and 500 words for a newton metre at
// each joint; the upper arm's encoder and motor go the other way. Registers in an order that no index can be
// mistaken for a joint.

#include "drivers/phantom/phantom_control.h"

namespace haptic::drivers::phantom {

inline Calibration toy_calibration() {
  return {.geometry = {.upper_arm = 0.2, .forearm = 0.15},
          .map = {.encoders = {4, 2, 3},
                  .encoder_bits = {16, 16, 16},
                  .motors = {1, 2, 0},
                  .largest_words = {1024, 1024, 1024},
                  .button = Button{.index = 6, .bit = 1, .is_low = false}},
          .counts_per_radian = {1000.0, -1000.0, 1000.0},
          .least_angles = glm::dvec3(-1.5),
          .greatest_angles = glm::dvec3(1.5),
          .words_per_torque = {500.0, -500.0, 500.0},
          .reference = Reference::kRestAtStart};
}

/// Input registers with these counts of base, upper arm and forearm, from the rest pose at counts of 0.
inline Registers toy_inputs(std::int16_t base, std::int16_t upper_arm, std::int16_t forearm,
                            bool pressed = false) {
  Registers inputs{};
  inputs[4] = static_cast<std::uint16_t>(base);
  inputs[2] = static_cast<std::uint16_t>(upper_arm);
  inputs[3] = static_cast<std::uint16_t>(forearm);
  inputs[6] = pressed ? 0x12 : 0x10;
  return inputs;
}

}  // namespace haptic::drivers::phantom
