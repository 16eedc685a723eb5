#pragma once
// Takes snapshots from the servo thread, events and statistics, and gives frames of them to subscribers. A
// frame is encoded once for all who want the same of it, and they share its bytes. io thread.
//
// Decimation is by tick count: of every `decimation` ticks, counted from tick 0, the first one that there is
// makes a frame. So a frame comes for each such group of ticks even when the servo thread skips some of them.
// Events are never decimated; statistics are as ticks are.

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <vector>

#include "ipc/encode.h"
#include "ipc/outbox.h"
#include "ipc/selection.h"
#include "servo/mailbox.h"

namespace haptic::ipc {

using ClientId = std::uint64_t;
inline constexpr ClientId kDaemonItself =
    0;  // subscribes, but needs no scenes or statistics to be kept for it
using FrameSink = std::function<void(const OutgoingFrame&)>;

/// The newest snapshot, as far as queries ask about it.
struct LatestTick {
  std::uint64_t tick = 0;
  std::uint64_t missed_ticks = 0;
  std::uint64_t scene_revision = 0;
  bool armed = false;
  bool paused = false;
  std::vector<servo::DeviceSnapshot> devices;
};

/// What one subscription is for.
struct Wish {
  TopicSet topics = 0;
  std::uint32_t decimation = 1;  // 0 means 1
  v1::Delivery delivery = v1::DELIVERY_UNSPECIFIED;
  Filter filter{};
};

class Publisher {
 public:
  /// Returns the number of the subscription, unique among all clients'.
  std::uint32_t subscribe(ClientId client, const Wish& wish, FrameSink sink);
  /// False if the client has no such subscription.
  bool unsubscribe(ClientId client, std::uint32_t subscription);
  void forget(ClientId client);
  std::size_t subscriptions_of(ClientId client) const noexcept;

  /// A scene that runs from now on: its names are what filters mean in snapshots of its revision.
  void learn(const v1::SceneDescription& scene);

  /// Publishes all snapshots that wait. Before one of a scene that it has not learnt, `learn_scenes` is
  /// called, which must.
  void drain(servo::SnapshotRing& ring, const std::function<void()>& learn_scenes);
  void publish(const servo::Snapshot& snapshot);
  void publish(const v1::Event& event);
  void publish(const v1::Stats& stats);
  /// Of a client.
  bool has_subscription_for(v1::Topic topic) const noexcept;

  const LatestTick& latest() const noexcept { return latest_; }

 private:
  /// What subscriptions that want the same of a tick share.
  struct View {
    TopicSet topics;
    Filter filter;
    Selection selection;
    bool is_resolved = false;
    SharedBytes body;  // of the snapshot at hand, once somebody needs it
  };
  struct Subscription {
    std::uint32_t number;
    ClientId client;
    TopicSet topics;
    std::uint64_t decimation;
    v1::Delivery delivery;
    std::shared_ptr<View> view;
    FrameSink sink;
    std::uint64_t sequence = 0;  // of the last frame
    bool has_ticked = false;     // a tick has come, so that another can be lost
    std::uint64_t last_stats = 0;
  };

  std::shared_ptr<View> view_of(TopicSet topics, const Filter& filter) const;
  const SharedBytes& encode(const servo::Snapshot& snapshot, View& view);
  void resolve(View& view, std::uint64_t revision) const;
  /// A frame with nothing but what every frame has.
  v1::Frame& plain_frame(std::uint64_t tick);
  void send(Subscription& subscription, TopicSet topics, std::uint64_t tick, const Loss& lost,
            const SharedBytes& body);
  void remember(const servo::Snapshot& snapshot);

  std::vector<Subscription> subscriptions_;
  std::uint32_t last_number_ = 0;
  std::deque<v1::SceneDescription> scenes_;  // the newest first
  LatestTick latest_;
  bool has_latest_ = false;
  v1::Frame frame_;  // kept for its memory
};

}  // namespace haptic::ipc
