#include "client/view/foxglove_viewer.h"

#include <google/protobuf/descriptor.h>

#include <algorithm>
#include <utility>

#include "foxglove/FrameTransforms.pb.h"
#include "foxglove/Log.pb.h"
#include "foxglove/SceneUpdate.pb.h"
#include "haptic/v1/telemetry.pb.h"
#include "proto/recording/schema_set.h"

namespace haptic::gateway {
namespace {

using foxglove_protocol::Level;

std::size_t index_of(Topic topic) noexcept { return static_cast<std::size_t>(topic) - 1; }

Topic topic_of(Slot slot) noexcept {
  switch (slot) {
    case Slot::kPlaces:
      return Topic::kPlaces;
    case Slot::kShapes:
    case Slot::kHips:
      return Topic::kScene;
    case Slot::kFrame:
      return Topic::kFrame;
    case Slot::kStats:
      break;
  }
  return Topic::kStats;
}

foxglove_protocol::Channel channel(Topic topic, const char* name, const google::protobuf::Descriptor& type) {
  return {static_cast<std::uint32_t>(topic), name, type.full_name(), recording::schema_of(type, 1).data};
}

template <class Item>
void push(Item item, std::deque<Item>& queue) {
  if (queue.size() >= FoxgloveViewer::kMostWords) {
    queue.pop_front();
  }
  queue.push_back(std::move(item));
}

}  // namespace

std::array<foxglove_protocol::Channel, kTopics> all_channels() {
  return {channel(Topic::kPlaces, "/tf", *::foxglove::FrameTransforms::descriptor()),
          channel(Topic::kScene, "/scene", *::foxglove::SceneUpdate::descriptor()),
          channel(Topic::kFrame, "/haptic/frame", *v1::Frame::descriptor()),
          channel(Topic::kLog, "/log", *::foxglove::Log::descriptor()),
          channel(Topic::kStats, "/stats", *v1::Stats::descriptor())};
}

bool FoxgloveViewer::wants(Topic topic) const noexcept { return subscriptions_[index_of(topic)].has_value(); }

bool FoxgloveViewer::lacks_shapes() noexcept { return std::exchange(lacks_shapes_, false); }

void FoxgloveViewer::set(Slot slot, Payload payload, std::uint64_t log_time_ns) {
  if (wants(topic_of(slot))) {
    slots_[static_cast<std::size_t>(slot)] = {std::move(payload), log_time_ns};
  }
}

void FoxgloveViewer::log(Payload payload, std::uint64_t log_time_ns) {
  if (wants(Topic::kLog)) {
    push(Waiting{std::move(payload), log_time_ns}, logs_);
  }
}

void FoxgloveViewer::tell(std::string text) { push(std::move(text), texts_); }

std::optional<Outgoing> FoxgloveViewer::take() {
  if (!texts_.empty()) {
    Outgoing out{std::move(texts_.front()), nullptr};
    texts_.pop_front();
    return out;
  }
  if (!logs_.empty()) {
    const Waiting waiting = std::move(logs_.front());
    logs_.pop_front();
    return pack(Topic::kLog, waiting);
  }
  // in turn, so that none of them waits for ever behind another one
  for (std::size_t i = 0; i < kSlots; ++i) {
    const std::size_t slot = next_slot_;
    next_slot_ = (next_slot_ + 1) % kSlots;
    if (slots_[slot].payload) {
      return pack(topic_of(static_cast<Slot>(slot)), std::exchange(slots_[slot], {}));
    }
  }
  return std::nullopt;
}

Outgoing FoxgloveViewer::pack(Topic topic, const Waiting& waiting) const {
  return {foxglove_protocol::message_head(subscriptions_[index_of(topic)].value_or(0), waiting.log_time_ns),
          waiting.payload};
}

void FoxgloveViewer::take(const foxglove_protocol::Request& request) {
  if (const auto* const wish = std::get_if<foxglove_protocol::Subscribe>(&request)) {
    for (const foxglove_protocol::Subscription& subscription : wish->subscriptions) {
      subscribe(subscription);
    }
  } else if (const auto* const end = std::get_if<foxglove_protocol::Unsubscribe>(&request)) {
    std::for_each(end->ids.begin(), end->ids.end(), [this](std::uint32_t id) { unsubscribe(id); });
  } else if (const auto* const other = std::get_if<foxglove_protocol::Unsupported>(&request)) {
    tell(foxglove_protocol::status(Level::kError, "haptic-view only shows: it does not do " + other->what));
  } else if (const auto* const invalid = std::get_if<foxglove_protocol::Invalid>(&request)) {
    tell(foxglove_protocol::status(Level::kError, "Invalid message: " + invalid->why));
  }
}

void FoxgloveViewer::subscribe(const foxglove_protocol::Subscription& wish) {
  if (wish.channel < 1 || wish.channel > kTopics) {
    tell(foxglove_protocol::status(Level::kError, "there is no channel " + std::to_string(wish.channel)));
    return;
  }
  std::optional<std::uint32_t>& subscription = subscriptions_[wish.channel - 1];
  if (subscription) {
    tell(foxglove_protocol::status(Level::kWarning,
                                   "channel " + std::to_string(wish.channel) + " is subscribed to already"));
    return;
  }
  if (std::find(subscriptions_.begin(), subscriptions_.end(), wish.id) != subscriptions_.end()) {
    tell(foxglove_protocol::status(Level::kError,
                                   "subscription " + std::to_string(wish.id) + " is in use already"));
    return;
  }
  subscription = wish.id;
  lacks_shapes_ = lacks_shapes_ || static_cast<Topic>(wish.channel) == Topic::kScene;
}

void FoxgloveViewer::unsubscribe(std::uint32_t id) {
  const auto found = std::find(subscriptions_.begin(), subscriptions_.end(), id);
  if (found == subscriptions_.end()) {
    return;
  }
  found->reset();
  if (!wants(Topic::kLog)) {
    logs_.clear();
  }
  for (std::size_t slot = 0; slot < kSlots; ++slot) {
    if (!wants(topic_of(static_cast<Slot>(slot)))) {
      slots_[slot] = {};
    }
  }
}

}  // namespace haptic::gateway
