#pragma once
// A snapshot as bytes of the wire. What all subscribers of one kind share is encoded once; what each has for
// itself, sequence and subscription, goes before it. That works since a message is the concatenation of its
// fields:
//
//     length | Envelope.frame | length | sequence | subscription | shared body: tick, objects, HIPs, devices

#include <cstdint>
#include <string>

#include "haptic/v1/control.pb.h"
#include "servo/mailbox.h"

namespace haptic::ipc {

/// Bit n: the topic with number n.
using TopicSet = std::uint32_t;
inline constexpr TopicSet topic_bit(v1::Topic topic) noexcept { return TopicSet{1} << topic; }

/// What a frame of these topics says beside sequence and subscription. `realtime_offset_ns` is CLOCK_REALTIME
/// - CLOCK_MONOTONIC.
void fill_frame(const servo::Snapshot& snapshot, TopicSet topics, std::int64_t realtime_offset_ns,
                v1::Frame& frame);

/// Appends all that stands before a shared body of `body_size` bytes.
void append_frame_head(std::uint64_t sequence, std::uint32_t subscription, std::size_t body_size,
                       std::string& out);

/// CLOCK_REALTIME - CLOCK_MONOTONIC now.
std::int64_t realtime_offset_ns() noexcept;

}  // namespace haptic::ipc
