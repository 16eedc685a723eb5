#pragma once
// What waits to be sent to one client. Two kinds of queue:
//
//     control: responses, events    never dropped; a client that lets it overflow is cut off
//     data:    frames, one queue for each subscription; bounded together, the oldest of all are dropped
//
// A subscription that wants the latest only has at most one frame waiting. Whatever frames are missing,
// dropped here or lost before, the next frame of that subscription is preceded by a Gap that tells which.
// Control goes first. Pure: knows no socket. io thread.

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "ipc/encode.h"

namespace haptic::ipc {

/// Bytes that many clients share.
using SharedBytes = std::shared_ptr<const std::string>;

struct OutboxLimits {
  std::size_t control_bytes = std::size_t{4} * 1024 * 1024;
  std::size_t data_bytes = std::size_t{4} * 1024 * 1024;  // one frame may be larger, then it is alone
  std::size_t data_frames = 1024;
};

/// Bytes to write one after another: `own`, then what is shared, if anything is.
struct Piece {
  std::string own;
  SharedBytes shared;
};

/// What frames that a client does not get were about.
struct Loss {
  TopicSet topics = 0;  // 0: none is lost
  std::uint64_t first_tick = 0;
  std::uint64_t last_tick = 0;

  /// As if both were one; `later` came after.
  void add(const Loss& later) noexcept;
};

/// A frame on its way to one subscription, without its head (encode.h).
struct OutgoingFrame {
  std::uint32_t subscription = 0;
  std::uint64_t sequence = 0;  // starts at 1 and ascends
  v1::Delivery delivery = v1::DELIVERY_UNSPECIFIED;
  TopicSet topics = 0;
  std::uint64_t tick = 0;
  Loss lost_before{};  // between the frame before and this, where their sequences say so
  SharedBytes body;
};

class Outbox {
 public:
  explicit Outbox(const OutboxLimits& limits) : limits_(limits) {}

  /// A whole message with its length. False if there is no room: the client must be cut off.
  bool push_control(std::string message);

  /// Drops the oldest frames if there is no room, and for v1::LATEST what waits of the subscription.
  void push_frame(OutgoingFrame frame);

  /// Drops the frames of a subscription that has ended.
  void forget(std::uint32_t subscription);

  void clear();

  /// What to write next: control, then frames while there are fewer than `bytes`. Empty if nothing waits.
  std::vector<Piece> take(std::size_t bytes);

 private:
  struct Waiting {
    std::uint64_t arrival;
    OutgoingFrame frame;
  };
  struct Queue {
    std::deque<Waiting> frames;
    Loss lost{};                  // before the next frame that comes
    std::uint64_t last_sent = 0;  // sequence
  };

  Queue* oldest();
  void drop_front(Queue& queue);
  std::size_t take_frames(Queue& queue, std::vector<Piece>& pieces);

  OutboxLimits limits_;
  std::deque<std::string> control_;
  std::size_t control_bytes_ = 0;
  std::map<std::uint32_t, Queue> queues_;  // by subscription
  std::uint64_t arrivals_ = 0;
  std::size_t data_frames_ = 0;
  std::size_t data_bytes_ = 0;
};

}  // namespace haptic::ipc
