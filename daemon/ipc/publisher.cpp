#include "ipc/publisher.h"

#include <algorithm>
#include <memory>
#include <utility>

namespace haptic::ipc {

std::uint32_t Publisher::subscribe(ClientId client, TopicSet topics, std::uint32_t decimation,
                                   FrameSink sink) {
  subscriptions_.push_back({++last_number_, client, topics, std::max(1U, decimation), std::move(sink)});
  return last_number_;
}

bool Publisher::unsubscribe(ClientId client, std::uint32_t subscription) {
  return std::erase_if(subscriptions_, [&](const Subscription& entry) {
           return entry.client == client && entry.number == subscription;
         }) > 0;
}

void Publisher::forget(ClientId client) {
  std::erase_if(subscriptions_, [client](const Subscription& entry) { return entry.client == client; });
}

std::size_t Publisher::subscriptions_of(ClientId client) const noexcept {
  return static_cast<std::size_t>(
      std::count_if(subscriptions_.begin(), subscriptions_.end(),
                    [client](const Subscription& entry) { return entry.client == client; }));
}

void Publisher::drain(servo::SnapshotRing& ring) {
  while (const servo::Snapshot* snapshot = ring.take()) {
    publish(*snapshot);
  }
}

void Publisher::publish(const servo::Snapshot& snapshot) {
  // ticks since the last snapshot that ran and were lost on the way here; those that never ran are no loss
  std::uint64_t lost = 0;
  if (has_latest_ && snapshot.tick > latest_.tick) {
    const std::uint64_t between = snapshot.tick - latest_.tick - 1;
    const std::uint64_t missed =
        snapshot.missed_ticks > latest_.missed_ticks ? snapshot.missed_ticks - latest_.missed_ticks : 0;
    lost = between - std::min(between, missed);
  }
  encoded_.clear();
  for (Subscription& subscription : subscriptions_) {
    const std::uint64_t group = snapshot.tick / subscription.decimation;
    const std::uint64_t last_group = latest_.tick / subscription.decimation;
    if (has_latest_ && group == last_group) {
      continue;
    }
    const std::uint64_t skipped = has_latest_ && group > last_group ? group - last_group - 1 : 0;
    // the first frame has no loss before it
    subscription.sequence += 1 + (subscription.sequence == 0 ? 0 : std::min(skipped, lost));
    subscription.sink(subscription.number, subscription.sequence, encode(snapshot, subscription.topics));
  }
  remember(snapshot);
}

const SharedBytes& Publisher::encode(const servo::Snapshot& snapshot, TopicSet topics) {
  for (const Encoded& entry : encoded_) {
    if (entry.topics == topics) {
      return entry.body;
    }
  }
  fill_frame(snapshot, topics, realtime_offset_ns(), frame_);
  encoded_.push_back({topics, std::make_shared<const std::string>(frame_.SerializeAsString())});
  return encoded_.back().body;
}

void Publisher::remember(const servo::Snapshot& snapshot) {
  latest_.tick = snapshot.tick;
  latest_.missed_ticks = snapshot.missed_ticks;
  latest_.armed = snapshot.armed;
  latest_.paused = snapshot.paused;
  latest_.devices.assign(snapshot.devices.begin(), snapshot.devices.end());
  has_latest_ = true;
}

}  // namespace haptic::ipc
