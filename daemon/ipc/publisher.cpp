#include "ipc/publisher.h"

#include <algorithm>
#include <utility>

namespace haptic::ipc {
namespace {

// snapshots wait for a few milliseconds at most, so that those of older scenes have long been taken
constexpr std::size_t kScenesKept = 4;

}  // namespace

std::uint32_t Publisher::subscribe(ClientId client, const Wish& wish, FrameSink sink) {
  subscriptions_.push_back({++last_number_, client, wish.topics, std::max(1U, wish.decimation), wish.delivery,
                            view_of(wish.topics & kTickTopics, wish.filter), std::move(sink)});
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

bool Publisher::has_subscription_for(v1::Topic topic) const noexcept {
  return std::any_of(subscriptions_.begin(), subscriptions_.end(), [topic](const Subscription& entry) {
    return entry.client != kDaemonItself && (entry.topics & topic_bit(topic)) != 0;
  });
}

void Publisher::learn(const v1::SceneDescription& scene) {
  v1::SceneDescription& names = scenes_.emplace_front();
  names.set_revision(scene.revision());
  *names.mutable_object() = scene.object();
  *names.mutable_finger() = scene.finger();
  scenes_.resize(std::min(scenes_.size(), kScenesKept));
}

void Publisher::drain(servo::SnapshotRing& ring, const std::function<void()>& learn_scenes) {
  while (const servo::Snapshot* snapshot = ring.take()) {
    if (scenes_.empty() || snapshot->scene_revision > scenes_.front().revision()) {
      learn_scenes();
    }
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
  for (Subscription& subscription : subscriptions_) {
    subscription.view->body.reset();
  }
  for (Subscription& subscription : subscriptions_) {
    const TopicSet topics = subscription.view->topics;
    const std::uint64_t group = snapshot.tick / subscription.decimation;
    const std::uint64_t last_group = latest_.tick / subscription.decimation;
    if (topics == 0 || (has_latest_ && group == last_group)) {
      continue;
    }
    Loss loss;
    // the first frame has no loss before it
    if (subscription.has_ticked && group > last_group) {
      const std::uint64_t frames = std::min(group - last_group - 1, lost);
      subscription.sequence += frames;
      loss = {frames > 0 ? topics : 0, latest_.tick + 1, snapshot.tick - 1};
    }
    subscription.has_ticked = true;
    send(subscription, topics, snapshot.tick, loss, encode(snapshot, *subscription.view));
  }
  remember(snapshot);
}

void Publisher::publish(const v1::Event& event) {
  SharedBytes body;
  for (Subscription& subscription : subscriptions_) {
    if ((subscription.topics & topic_bit(v1::EVENTS)) == 0) {
      continue;
    }
    if (!body) {
      *plain_frame(event.tick()).mutable_event() = event;
      body = std::make_shared<const std::string>(frame_.SerializeAsString());
    }
    send(subscription, topic_bit(v1::EVENTS), event.tick(), {}, body);
  }
}

void Publisher::publish(const v1::Stats& stats) {
  SharedBytes body;
  for (Subscription& subscription : subscriptions_) {
    const std::uint64_t group = stats.tick() / subscription.decimation + 1;
    if ((subscription.topics & topic_bit(v1::STATS)) == 0 || group == subscription.last_stats) {
      continue;
    }
    subscription.last_stats = group;
    if (!body) {
      *plain_frame(stats.tick()).mutable_stats() = stats;
      body = std::make_shared<const std::string>(frame_.SerializeAsString());
    }
    send(subscription, topic_bit(v1::STATS), stats.tick(), {}, body);
  }
}

void Publisher::send(Subscription& subscription, TopicSet topics, std::uint64_t tick, const Loss& lost,
                     const SharedBytes& body) {
  subscription.sink({.subscription = subscription.number,
                     .sequence = ++subscription.sequence,
                     .delivery = subscription.delivery,
                     .topics = topics,
                     .tick = tick,
                     .lost_before = lost,
                     .body = body});
}

std::shared_ptr<Publisher::View> Publisher::view_of(TopicSet topics, const Filter& filter) const {
  for (const Subscription& entry : subscriptions_) {
    if (entry.view->topics == topics && entry.view->filter == filter) {
      return entry.view;
    }
  }
  return std::make_shared<View>(
      View{.topics = topics, .filter = filter, .selection = {}, .is_resolved = false, .body = {}});
}

const SharedBytes& Publisher::encode(const servo::Snapshot& snapshot, View& view) {
  if (!view.body) {
    resolve(view, snapshot.scene_revision);
    fill_frame(snapshot, view.topics, view.selection, realtime_offset_ns(), frame_);
    view.body = std::make_shared<const std::string>(frame_.SerializeAsString());
  }
  return view.body;
}

void Publisher::resolve(View& view, std::uint64_t revision) const {
  if (view.is_resolved && view.selection.revision == revision) {
    return;
  }
  const auto scene =
      std::find_if(scenes_.begin(), scenes_.end(),
                   [revision](const v1::SceneDescription& entry) { return entry.revision() == revision; });
  view.selection = select(view.filter, scene == scenes_.end() ? v1::SceneDescription() : *scene);
  view.selection.revision = revision;
  view.is_resolved = true;
}

v1::Frame& Publisher::plain_frame(std::uint64_t tick) {
  frame_.Clear();
  const std::uint64_t now = monotonic_ns();
  frame_.set_tick(tick);
  frame_.set_monotonic_ns(now);
  frame_.set_realtime_ns(now + static_cast<std::uint64_t>(realtime_offset_ns()));
  frame_.set_scene_revision(latest_.scene_revision);
  frame_.set_armed(latest_.armed);
  frame_.set_paused(latest_.paused);
  return frame_;
}

void Publisher::remember(const servo::Snapshot& snapshot) {
  latest_.tick = snapshot.tick;
  latest_.missed_ticks = snapshot.missed_ticks;
  latest_.scene_revision = snapshot.scene_revision;
  latest_.armed = snapshot.armed;
  latest_.paused = snapshot.paused;
  latest_.devices.assign(snapshot.devices.begin(), snapshot.devices.end());
  has_latest_ = true;
}

}  // namespace haptic::ipc
