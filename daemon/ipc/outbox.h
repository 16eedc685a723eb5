#pragma once
// What waits to be sent to one client. Two queues:
//
//     control: responses, events    never dropped; a client that lets it overflow is cut off
//     data:    frames               bounded; the oldest are dropped
//
// Whatever frames are missing, dropped here or lost before, the next frame of that subscription is preceded
// by a Gap that tells which. Control goes first. Pure: knows no socket. io thread.

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <vector>

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

class Outbox {
 public:
  explicit Outbox(const OutboxLimits& limits) noexcept : limits_(limits) {}

  /// A whole message with its length. False if there is no room: the client must be cut off.
  bool push_control(std::string message);

  /// A frame, without its head (encode.h). Sequences of a subscription start at 1 and ascend. Drops the
  /// oldest frames if there is no room.
  void push_frame(std::uint32_t subscription, std::uint64_t sequence, SharedBytes body);

  /// Drops the frames of a subscription that has ended.
  void forget(std::uint32_t subscription);

  void clear();

  /// What to write next: control, then frames while there are fewer than `bytes`. Empty if nothing waits.
  std::vector<Piece> take(std::size_t bytes);

 private:
  struct Waiting {
    std::uint32_t subscription;
    std::uint64_t sequence;
    SharedBytes body;
  };

  void drop_oldest();

  OutboxLimits limits_;
  std::deque<std::string> control_;
  std::size_t control_bytes_ = 0;
  std::deque<Waiting> data_;
  std::size_t data_bytes_ = 0;
  std::map<std::uint32_t, std::uint64_t> last_sent_;  // sequence, by subscription
};

}  // namespace haptic::ipc
