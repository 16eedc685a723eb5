#include "client/view/foxglove_feed.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "client/view/foxglove_scene.h"
#include "client/view/policy.h"
#include "proto/foxglove/scene_view.h"

namespace haptic::gateway {
namespace {

using foxglove_protocol::Level;

constexpr std::string_view kDaemonStatus = "daemon";  // the id of what is told of the daemon

enum Id : std::uint64_t { kScene = 10, kSceneWithoutMeshes, kDevices, kFrames, kStats };

std::uint64_t now_ns() {
  return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(
                                        std::chrono::system_clock::now().time_since_epoch())
                                        .count());
}

v1::Envelope subscription(Id id, std::initializer_list<v1::Topic> topics, std::uint32_t decimation) {
  v1::Envelope envelope;
  envelope.mutable_request()->set_id(id);
  v1::Subscribe& wish = *envelope.mutable_request()->mutable_subscribe();
  for (const v1::Topic topic : topics) {
    wish.add_topic(topic);
  }
  wish.set_decimation(decimation);
  wish.set_delivery(v1::LATEST);
  return envelope;
}

}  // namespace

FoxgloveFeed::FoxgloveFeed(boost::asio::io_context& io, const DaemonDoor& door, double frames_per_second,
                           Log& log)
    : io_(io), door_(door), frames_per_second_(frames_per_second), log_(log), timer_(io) {}

FoxgloveFeed::~FoxgloveFeed() {
  try {
    disconnect();
  } catch (const std::exception&) {
    // a timer that cannot be cancelled says no more than that the program ends
  }
}

void FoxgloveFeed::add(Listener& listener) {
  listeners_.push_back(&listener);
  if (listeners_.size() == 1) {
    backoff_.reset();
    connect();
  } else if (!problem_.empty()) {
    listener.viewer().tell(foxglove_protocol::status(Level::kError, problem_, kDaemonStatus));
  }
}

void FoxgloveFeed::remove(Listener& listener) {
  std::erase(listeners_, &listener);
  if (listeners_.empty()) {
    disconnect();
    problem_.clear();
  }
}

void FoxgloveFeed::catch_up(FoxgloveViewer& viewer) const {
  if (viewer.lacks_shapes() && shapes_) {
    viewer.set(Slot::kShapes, shapes_, shapes_time_ns_);
  }
}

void FoxgloveFeed::connect() {
  link_ = std::make_shared<DaemonLink>(io_, door_);
  link_->open([this](const DaemonLink::Greeting& greeting) { opened(greeting); },
              [this](const std::string& why) { lost(why); });
}

void FoxgloveFeed::disconnect() {
  timer_.cancel();
  if (link_) {
    link_->close();
    link_.reset();
  }
  shapes_.reset();
  scene_.Clear();
  asks_scene_ = false;
}

void FoxgloveFeed::opened(const DaemonLink::Greeting& greeting) {
  backoff_.reset();
  log_.tell("viewers see the daemon at " + door_.name());
  if (!problem_.empty()) {
    problem_.clear();
    for (Listener* const listener : listeners_) {
      listener->viewer().tell(foxglove_protocol::remove_status(kDaemonStatus));
    }
  }
  ask_scene(true);
  v1::Envelope devices;
  devices.mutable_request()->set_id(kDevices);
  devices.mutable_request()->mutable_list_devices();
  link_->send(devices);
  link_->send(subscription(kFrames, {v1::OBJECTS, v1::HIPS, v1::DEVICES},
                           least_decimation(greeting.rate_hz, frames_per_second_)));
  link_->send(subscription(kStats, {v1::STATS}, 1));
  flush();
  read();
}

void FoxgloveFeed::lost(const std::string& why) {
  if (problem_ != why) {
    log_.tell(why + "; trying again");
    problem_ = why;
    for (Listener* const listener : listeners_) {
      listener->viewer().tell(foxglove_protocol::status(Level::kError, why, kDaemonStatus));
    }
    flush();
  }
  disconnect();
  timer_.expires_after(backoff_.next());
  timer_.async_wait([this](const boost::system::error_code& error) {
    if (!error && !listeners_.empty()) {
      connect();
    }
  });
}

void FoxgloveFeed::read() {
  link_->read([this](std::string_view message) {
    v1::Envelope envelope;
    if (!envelope.ParseFromArray(message.data(), static_cast<int>(message.size()))) {
      lost("what listens at " + door_.name() + " is not a hapticd: a message cannot be read");
      return;
    }
    if (envelope.has_goodbye()) {
      lost("the daemon says: " + envelope.goodbye().error().message());
      return;
    }
    take(envelope);
    flush();
    read();
  });
}

void FoxgloveFeed::take(const v1::Envelope& envelope) {
  if (envelope.has_frame()) {
    take_frame(envelope.frame());
  } else if (envelope.has_event()) {
    take_event(envelope.event());
  } else if (envelope.has_response()) {
    take_response(envelope.response());
  }
}

void FoxgloveFeed::ask_scene(bool with_meshes) {
  asks_scene_ = true;
  v1::Envelope envelope;
  envelope.mutable_request()->set_id(with_meshes ? kScene : kSceneWithoutMeshes);
  envelope.mutable_request()->mutable_get_scene()->set_embed_meshes(with_meshes);
  link_->send(envelope);
}

void FoxgloveFeed::take_response(const v1::Response& response) {
  if (response.id() == kScene && response.has_error()) {
    // larger than the daemon sends: its meshes are drawn as their names
    log_.tell("the scene comes without meshes: " + response.error().message());
    ask_scene(false);
    return;
  }
  if (response.has_error()) {
    log_.tell("the daemon refused: " + response.error().message());
    return;
  }
  if (response.has_devices()) {
    devices_.clear();
    for (const v1::DeviceStatus& device : response.devices().device()) {
      devices_.push_back(device.description().name());
    }
  } else if (response.has_scene()) {
    asks_scene_ = false;
    scene_ = response.scene();
    shapes_time_ns_ = now_ns();
    shapes_ = std::make_shared<const std::string>(
        view::draw_shapes(scene_, surfaces_of(scene_), shapes_time_ns_).SerializeAsString());
    for (Listener* const listener : listeners_) {
      listener->viewer().set(Slot::kShapes, shapes_, shapes_time_ns_);
    }
  }
}

void FoxgloveFeed::take_frame(const v1::Frame& frame) {
  if (frame.has_stats()) {
    if (wants(Topic::kStats)) {
      set(Slot::kStats, frame.stats().SerializeAsString(), frame.realtime_ns());
    }
    return;
  }
  if (wants(Topic::kFrame)) {
    set(Slot::kFrame, frame.SerializeAsString(), frame.realtime_ns());
  }
  if (frame.scene_revision() != scene_.revision()) {
    // its names are not known yet
    if (!asks_scene_) {
      ask_scene(true);
    }
    return;
  }
  if (wants(Topic::kPlaces)) {
    set(Slot::kPlaces, view::draw_places(scene_, devices_, frame).SerializeAsString(), frame.realtime_ns());
  }
  if (wants(Topic::kScene)) {
    set(Slot::kHips, view::draw_hips(frame).SerializeAsString(), frame.realtime_ns());
  }
}

void FoxgloveFeed::take_event(const v1::Event& event) {
  if (event.kind() == v1::Event::SCENE_CHANGED) {
    asks_scene_ = false;  // one that could not be had may be followed by one that can
  }
  if (!wants(Topic::kLog)) {
    return;
  }
  const std::uint64_t now = now_ns();
  const auto payload = std::make_shared<const std::string>(view::log_of(event, now).SerializeAsString());
  for (Listener* const listener : listeners_) {
    listener->viewer().log(payload, now);
  }
}

bool FoxgloveFeed::wants(Topic topic) const {
  return std::any_of(listeners_.begin(), listeners_.end(),
                     [topic](Listener* listener) { return listener->viewer().wants(topic); });
}

void FoxgloveFeed::set(Slot slot, std::string message, std::uint64_t time_ns) {
  const auto payload = std::make_shared<const std::string>(std::move(message));
  for (Listener* const listener : listeners_) {
    listener->viewer().set(slot, payload, time_ns);
  }
}

void FoxgloveFeed::flush() {
  // one that ends is removed only later, by its socket
  for (Listener* const listener : listeners_) {
    listener->flush();
  }
}

}  // namespace haptic::gateway
