#pragma once
// A snapshot as bytes of the wire. What all subscribers of one kind share is encoded once; what each has for
// itself, sequence and subscription, goes before it. That works since a message is the concatenation of its
// fields:
//
//     length | Envelope.frame | length | sequence | subscription | shared body: tick, objects, HIPs, devices
//
// Frames of one subscription that wait together go in one envelope:
//
//     length | Envelope.batch | length | FrameBatch.frame | length | sequence | subscription | body |
//                                        FrameBatch.frame | ...

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "haptic/v1/control.pb.h"
#include "ipc/selection.h"
#include "servo/mailbox.h"

namespace haptic::ipc {

/// Bit n: the topic with number n.
using TopicSet = std::uint32_t;
inline constexpr TopicSet topic_bit(v1::Topic topic) noexcept { return TopicSet{1} << topic; }

/// The topics that a frame tells of each tick.
inline constexpr TopicSet kTickTopics =
    topic_bit(v1::OBJECTS) | topic_bit(v1::HIPS) | topic_bit(v1::DEVICES) | topic_bit(v1::INPUTS);

/// What a frame of these topics says beside sequence and subscription. `realtime_offset_ns` is CLOCK_REALTIME
/// - CLOCK_MONOTONIC.
void fill_frame(const servo::Snapshot& snapshot, TopicSet topics, const Selection& selection,
                std::int64_t realtime_offset_ns, v1::Frame& frame);

/// Appends all that stands before a shared body of `body_size` bytes.
void append_frame_head(std::uint64_t sequence, std::uint32_t subscription, std::size_t body_size,
                       std::string& out);

/// What of a frame is its own: its shared body comes after.
struct FrameHead {
  std::uint64_t sequence;
  std::uint32_t subscription;
  std::size_t body_size;
};

/// The heads of one batch: the first has the batch's own before it. Each body goes after its head.
std::vector<std::string> batch_heads(std::span<const FrameHead> frames);

/// CLOCK_REALTIME - CLOCK_MONOTONIC now.
std::int64_t realtime_offset_ns() noexcept;

/// CLOCK_MONOTONIC now.
std::uint64_t monotonic_ns() noexcept;

}  // namespace haptic::ipc
