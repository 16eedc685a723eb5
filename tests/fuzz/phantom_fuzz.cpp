// Registers of a PHANToM's card: whatever they say, no word leaves its range or goes to another output, none
// pushes unless the position is trusted, and what is told is finite. The first byte is the number of bits of
// the counters, then each reading is three words of 4 bytes and a byte for the button and the time that
// passed.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <span>

#include "drivers/phantom/phantom_control.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace haptic::drivers;
  if (size == 0) return 0;
  const unsigned bits = 8 + data[0] % 25;
  phantom::PhantomControl control(
      {.calibration = {.geometry = {.upper_arm = 0.2, .forearm = 0.15},
                       .map = {.encoders = {0, 1, 2},
                               .encoder_bits = {bits, bits, bits},
                               .motors = {3, 4, 5},
                               .largest_words = {1000, 2000, 2047},
                               .button = phantom::Button{}},
                       .counts_per_radian = {100.0, -1000.0, 3000.0},
                       .least_angles = glm::dvec3(-1.5),
                       .greatest_angles = glm::dvec3(1.5),
                       .words_per_torque = {5e3, -5e3, 1e6},
                       .reference = static_cast<phantom::Reference>(data[0] / 25 % 3)},
       .max_force = 10.0,
       .ramp = 2'000'000});
  Nanoseconds now = 0;
  std::span<const std::uint8_t> bytes(data + 1, size - 1);
  for (constexpr std::size_t kReading = 13; bytes.size() >= kReading; bytes = bytes.subspan(kReading)) {
    phantom::Registers inputs{};
    std::memcpy(inputs.data(), bytes.data(), 12);
    inputs[6] = bytes[12] & 2U;
    now += Nanoseconds{bytes[12]} * 100'000;
    control.take(inputs, now);
    const phantom::Registers outputs =
        control.next_outputs({.expires = now + 1, .force = {3.0, -2.0, 1.0}}, now);
    const bool is_quiet = outputs == phantom::no_torque();
    if (!is_quiet && (control.hold(now) != phantom::Hold::kNone || !control.sample())) std::abort();
    for (const std::uint32_t word : outputs) {
      if (word < 1 || word > 4095) std::abort();
    }
    if (outputs[3] < 1048 || outputs[3] > 3048 || outputs[0] != phantom::kNoTorque) std::abort();
    if (!control.sample()) continue;
    const DeviceSample& sample = *control.sample();
    if (!std::isfinite(sample.position.x + sample.position.y + sample.position.z)) std::abort();
    if (!std::isfinite(sample.velocity.x + sample.velocity.y + sample.velocity.z)) std::abort();
  }
  return 0;
}
