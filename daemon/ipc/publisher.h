#pragma once
// Takes snapshots from the servo thread and gives frames to subscribers. A frame is encoded once for all who
// want the same topics in the same ticks, and they share its bytes. io thread.
//
// Decimation is by tick count: of every `decimation` ticks, counted from tick 0, the first one that there is
// makes a frame. So a frame comes for each such group of ticks even when the servo thread skips some of them.

#include <cstdint>
#include <functional>
#include <vector>

#include "ipc/encode.h"
#include "ipc/outbox.h"
#include "servo/mailbox.h"

namespace haptic::ipc {

using ClientId = std::uint64_t;
/// Takes a frame for one subscription; its sequence starts at 1.
using FrameSink = std::function<void(std::uint32_t subscription, std::uint64_t sequence, SharedBytes body)>;

/// The newest snapshot, as far as queries ask about it.
struct LatestTick {
  std::uint64_t tick = 0;
  std::uint64_t missed_ticks = 0;
  bool armed = false;
  bool paused = false;
  std::vector<servo::DeviceSnapshot> devices;
};

class Publisher {
 public:
  /// Returns the number of the subscription, unique among all clients'. 0 as decimation means 1.
  std::uint32_t subscribe(ClientId client, TopicSet topics, std::uint32_t decimation, FrameSink sink);
  /// False if the client has no such subscription.
  bool unsubscribe(ClientId client, std::uint32_t subscription);
  void forget(ClientId client);
  std::size_t subscriptions_of(ClientId client) const noexcept;

  /// Publishes all snapshots that wait.
  void drain(servo::SnapshotRing& ring);
  void publish(const servo::Snapshot& snapshot);

  const LatestTick& latest() const noexcept { return latest_; }

 private:
  struct Subscription {
    std::uint32_t number;
    ClientId client;
    TopicSet topics;
    std::uint64_t decimation;
    FrameSink sink;
    std::uint64_t sequence = 0;  // of the last frame
  };
  struct Encoded {
    TopicSet topics;
    SharedBytes body;
  };

  const SharedBytes& encode(const servo::Snapshot& snapshot, TopicSet topics);
  void remember(const servo::Snapshot& snapshot);

  std::vector<Subscription> subscriptions_;
  std::uint32_t last_number_ = 0;
  LatestTick latest_;
  bool has_latest_ = false;
  std::vector<Encoded> encoded_;  // of the snapshot at hand
  v1::Frame frame_;               // kept for its memory
};

}  // namespace haptic::ipc
