#pragma once
// What another program says of its device, and what it is answered: the messages of
// proto/device/haptic_device.h, checked. Pure; real-time safe.

#include <cstddef>
#include <cstdint>
#include <span>
#include <variant>

#include "drivers/device.h"
#include "proto/device/haptic_device.h"

namespace haptic::drivers::external {

/// What a message must follow.
struct Conversation {
  std::uint64_t last_sequence = 0;
  Nanoseconds last_time = 0;
};

/// The sample in `message`, or why its sender is refused. A number that is not finite is passed on: it cuts
/// force at once, where a refusal would have to grow old first. An orientation is normalised; it may be off
/// by 1e-3. `now` is CLOCK_MONOTONIC; `conversation` moves on if the message is a sample.
std::variant<DeviceSample, haptic_refusal> read_sample(std::span<const std::byte> message, Nanoseconds now,
                                                       Conversation& conversation) noexcept;

/// The answer to the sample of that sequence; it expires kForceLifetime from now at the latest.
haptic_force write_force(const ForceCommand& live, std::uint64_t sequence, Nanoseconds now) noexcept;

/// The last message to a peer.
haptic_force write_refusal(haptic_refusal refusal) noexcept;

/// In words, for a person.
const char* in_words(haptic_refusal refusal) noexcept;

}  // namespace haptic::drivers::external
