// Reports of a SpaceMouse, each after a byte with its length: no axis is beyond full deflection, and the pose
// stays in reach.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "drivers/spacemouse/spacemouse_motion.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace haptic::drivers;
  std::span<const std::uint8_t> bytes(data, size);
  spacemouse::Decoder decoder;
  spacemouse::Motion motion({.speed = 2.0, .turn_rate = 20.0, .reach = 0.1});
  Nanoseconds now = 0;
  while (!bytes.empty()) {
    const std::size_t length = std::min<std::size_t>(bytes[0], bytes.size() - 1);
    now += 8'000'000;
    if (decoder.take(bytes.subspan(1, length)) != spacemouse::Report::kUnknown) motion.take(decoder, now);
    bytes = bytes.subspan(1 + length);
    const auto sample = motion.advance(now);
    for (int axis = 0; axis < 3; ++axis) {
      if (!(std::abs(decoder.deflection().translation[axis]) <= 1.0)) std::abort();
      if (!(std::abs(decoder.deflection().rotation[axis]) <= 1.0)) std::abort();
      if (sample && !(std::abs(sample->position[axis]) <= 0.1)) std::abort();
    }
    if (sample && !(std::abs(glm::length(sample->orientation) - 1.0) < 1e-9)) std::abort();
  }
  return 0;
}
