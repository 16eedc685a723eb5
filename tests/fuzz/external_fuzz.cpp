// What another program may send for its device: arbitrary bytes as messages of the external driver. The first
// byte of each gives its length, or all that is left. Whatever they are: a sample that is taken has a time
// that is not in future, a sequence that ascends, and numbers that are within bounds or none; a refusal tells
// why.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <variant>

#include "drivers/external/external_protocol.h"

namespace {

using namespace haptic::drivers;

constexpr Nanoseconds kNow = 1'000'000'000;

void require(bool holds) {
  if (!holds) std::abort();
}

bool is_within(const glm::dvec3& v, double bound) {
  for (int i = 0; i < 3; ++i) {
    if (std::isfinite(v[i]) && std::abs(v[i]) > bound) return false;
  }
  return true;
}

void require_sound(const DeviceSample& sample) {
  require(sample.time <= kNow && is_within(sample.position, 1e6));
  const double length = glm::length(sample.orientation);
  require(std::isnan(length) || std::abs(length - 1.0) < 1e-9);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::span<const std::byte> rest = std::as_bytes(std::span(data, size));
  external::Conversation conversation;
  while (!rest.empty()) {
    const std::size_t length = std::min<std::size_t>(std::to_integer<std::size_t>(rest[0]), rest.size() - 1);
    const external::Conversation before = conversation;
    const auto read = external::read_sample(rest.subspan(1, length), kNow, conversation);
    if (const auto* const refusal = std::get_if<haptic_refusal>(&read)) {
      require(*refusal == HAPTIC_MALFORMED || *refusal == HAPTIC_OTHER_VERSION);
      require(conversation.last_sequence == before.last_sequence);
    } else {
      require(length == sizeof(haptic_sample) && conversation.last_sequence > before.last_sequence &&
              conversation.last_time >= before.last_time);
      require_sound(std::get<DeviceSample>(read));
    }
    rest = rest.subspan(1 + length);
  }
  return 0;
}
