#include "client/bridge/bridge.h"

#include <algorithm>
#include <condition_variable>
#include <utility>

#include "client/bridge/subject.h"
#include "client/lib/backoff.h"
#include "client/lib/error.h"

namespace haptic::bridge {
namespace {

using namespace std::chrono_literals;

constexpr auto kReadPatience = 200ms;    // how soon the reader sees that it shall stop
constexpr auto kPublishPatience = 20ms;  // how long a request may wait while there is nothing to publish
constexpr auto kSilence = 5s;            // of a daemon, before it is asked whether it is there
constexpr auto kLastingSession = 1s;     // one that ended sooner does not begin the back-off anew
constexpr auto kStatusPeriod = 1s;
constexpr auto kFinish = 2s;          // for what waits at the end
constexpr int kMessagesAtOnce = 256;  // before requests are looked at again
constexpr int kAnswersAtOnce = 16;    // before frames are looked at again
constexpr std::size_t kNoLane = static_cast<std::size_t>(-1);

void pause(const std::stop_token& stop, std::chrono::milliseconds time) {
  std::mutex mutex;
  std::condition_variable_any never;
  std::unique_lock lock(mutex);
  never.wait_for(lock, stop, time, [] { return false; });
}

bool is_of_ticks(v1::Topic topic) { return topic != v1::EVENTS && topic != v1::STATS; }

std::vector<Lane> lanes_of(const Options& options) {
  std::vector<Lane> lanes;
  lanes.reserve(options.topics.size());
  for (const v1::Topic topic : options.topics) {
    lanes.push_back({.subject = subject(options.host, topic_name(topic)),
                     .topic = topic,
                     .keep = is_of_ticks(topic) ? options.keep : Keep::kAll});
  }
  return lanes;
}

}  // namespace

Bridge::Bridge(Options options, std::function<void(const std::string&)> log)
    : options_(std::move(options)),
      log_(std::move(log)),
      outbox_(lanes_of(options_), subject(options_.host, "gap"), options_.buffer) {
  check(options_.broker);
  status_.set_version(HAPTIC_VERSION);
  reader_ = std::jthread([this](const std::stop_token& stop) { read(stop); });
  publisher_ = std::jthread([this](const std::stop_token& stop) { publish(stop); });
}

void Bridge::stop() {
  // one after the other, so that all that was read is published
  for (std::jthread* thread : {&reader_, &publisher_}) {
    if (thread->joinable()) {
      thread->request_stop();
      thread->join();
    }
  }
}

v1::BridgeStatus Bridge::status() const {
  v1::BridgeStatus status;
  {
    const std::lock_guard lock(mutex_);
    status = status_;
  }
  status.set_uptime(std::chrono::duration<double>(Clock::now() - start_).count());
  outbox_.report(status);
  return status;
}

void Bridge::set_link(bool is_daemon, bool connected, const std::string& text) {
  const std::lock_guard lock(mutex_);
  v1::BridgeStatus::Link& link = is_daemon ? *status_.mutable_daemon() : *status_.mutable_broker();
  if (!connected && !link.connected() && link.problem() == text) {
    return;
  }
  link.set_connected(connected);
  link.set_problem(connected ? "" : text);
  if (connected) {
    link.set_connections(link.connections() + 1);
    link.set_peer(text);
  }
  const std::string who = is_daemon ? "daemon: " : "broker: ";
  log_(connected ? who + "connected to " + text : who + text + "; trying again");
}

// --- the reader -------------------------------------------------------------------------------------------

void Bridge::read(const std::stop_token& stop) {
  client::Backoff backoff;
  while (!stop.stop_requested()) {
    const Clock::time_point begin = Clock::now();
    try {
      read_session(stop);
    } catch (const client::Error& error) {
      set_link(true, false, error.what());
    }
    if (Clock::now() - begin > kLastingSession) {
      backoff.reset();
    }
    pause(stop, backoff.next());
  }
}

void Bridge::read_session(const std::stop_token& stop) {
  client::Connection daemon(options_.daemon);
  subscribe(daemon);
  set_link(true, true, daemon.daemon().program() + " " + daemon.daemon().version());
  fetch_scene(daemon);
  Clock::time_point heard = Clock::now();
  while (!stop.stop_requested()) {
    if (const auto message = daemon.receive(kReadPatience)) {
      pass_on(*message, daemon);
      heard = Clock::now();
    } else if (Clock::now() - heard > kSilence) {
      v1::Request request;
      request.mutable_get_status();
      daemon.call(std::move(request));  // throws if there is no answer
      heard = Clock::now();
    }
  }
}

// one for each topic, so that each subject has a sequence without holes
void Bridge::subscribe(client::Connection& daemon) {
  subscriptions_.clear();
  for (const v1::Topic topic : options_.topics) {
    v1::Subscribe wish;
    wish.add_topic(topic);
    wish.set_decimation(options_.decimation);
    wish.set_delivery(is_of_ticks(topic) && options_.keep == Keep::kLatest ? v1::LATEST : v1::LOSSLESS);
    subscriptions_.push_back(daemon.subscribe(std::move(wish)));
  }
}

std::size_t Bridge::lane_of(std::uint32_t subscription) const {
  const auto found = std::find(subscriptions_.begin(), subscriptions_.end(), subscription);
  return found == subscriptions_.end() ? kNoLane : static_cast<std::size_t>(found - subscriptions_.begin());
}

void Bridge::pass_on(const v1::Envelope& message, client::Connection& daemon) {
  std::uint64_t revision = 0;
  if (message.has_frame()) {
    if (const std::size_t lane = lane_of(message.frame().subscription()); lane != kNoLane) {
      outbox_.add(lane, message.frame());
    }
    revision = message.frame().scene_revision();
  } else if (message.has_gap()) {
    if (const std::size_t lane = lane_of(message.gap().subscription()); lane != kNoLane) {
      outbox_.add_gap(lane, message.gap());
    }
  } else if (message.has_event()) {
    revision = message.event().scene_revision();
  }
  // what is still on its way may be of an older scene
  if (revision > scene_revision_) {
    fetch_scene(daemon);
  }
}

void Bridge::fetch_scene(client::Connection& daemon) {
  v1::Request request;
  request.mutable_get_scene();
  const v1::Response response = daemon.call(std::move(request));
  scene_revision_ = response.scene().revision();
  const std::lock_guard lock(mutex_);
  response.scene().SerializeToString(&scene_);
  is_scene_due_ = true;
}

// --- the publisher ----------------------------------------------------------------------------------------

void Bridge::publish(const std::stop_token& stop) {
  client::Backoff backoff;
  Clock::time_point opened = start_;
  while (!stop.stop_requested()) {
    try {
      open_broker();
      opened = Clock::now();
      publish_session(stop);
    } catch (const BrokerError& error) {
      set_link(false, false, error.what());
      if (broker_ && Clock::now() - opened > kLastingSession) {
        backoff.reset();
      }
      broker_.reset();
      pause(stop, backoff.next());
    }
  }
  finish();
}

// until it shall stop, or the broker ends the connection for good; why, the next attempt to connect tells
// best
void Bridge::publish_session(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    if (broker_->state() == Broker::State::kClosed) {
      throw BrokerError("the connection was ended");
    }
    if (is_broker_there()) {
      publish_some(kPublishPatience);
    } else {
      pause(stop, kPublishPatience);
    }
  }
}

void Bridge::open_broker() {
  broker_ = std::make_unique<Broker>(
      options_.broker,
      std::vector<std::string>{subject(options_.host, "scene.get"), subject(options_.host, "status.get")});
  seen_connections_ = 0;
}

bool Bridge::is_broker_there() {
  if (broker_->state() != Broker::State::kConnected) {
    const std::string problem = broker_->problem();
    set_link(false, false, problem.empty() ? "the connection was lost" : problem);
    return false;
  }
  if (const std::uint64_t connections = broker_->connections(); connections != seen_connections_) {
    seen_connections_ = connections;
    set_link(false, true, broker_->server());
    next_status_ = Clock::now();
    const std::lock_guard lock(mutex_);
    is_scene_due_ = !scene_.empty();
  }
  return true;
}

void Bridge::publish_some(std::chrono::milliseconds patience) {
  for (int i = 0; i < kAnswersAtOnce; ++i) {
    const std::optional<Question> question = broker_->next_question();
    if (!question) {
      break;
    }
    send(question->reply, question->subject == 0 ? scene_bytes() : status_bytes(false));
  }
  publish_scene_and_status();
  for (int i = 0; i < kMessagesAtOnce; ++i) {
    const std::optional<Outgoing> message = outbox_.take(i == 0 ? patience : 0ms);
    if (!message) {
      break;
    }
    send(*message);
    if (broker_->state() != Broker::State::kConnected) {
      break;
    }
  }
}

void Bridge::publish_scene_and_status() {
  std::string scene;
  {
    const std::lock_guard lock(mutex_);
    if (std::exchange(is_scene_due_, false)) {
      scene = scene_;
    }
  }
  if (!scene.empty()) {
    send(subject(options_.host, "scene"), scene);
  }
  if (Clock::now() >= next_status_) {
    send(subject(options_.host, "status"), status_bytes(false));
    next_status_ = Clock::now() + kStatusPeriod;
  }
}

void Bridge::send(const Outgoing& message) {
  if (send(message.subject, message.payload)) {
    outbox_.published(message);
  } else {
    outbox_.failed(message);
  }
}

bool Bridge::send(const std::string& subject, const std::string& payload) {
  if (payload.size() > broker_->payload_limit() && !std::exchange(has_told_size_, true)) {
    const std::lock_guard lock(mutex_);
    log_("broker: it takes " + std::to_string(broker_->payload_limit()) +
         " bytes at once, and a message on " + subject + " has " + std::to_string(payload.size()) +
         "; such messages are dropped (max_payload of the server's config)");
  }
  return broker_->publish(subject, payload);
}

std::string Bridge::status_bytes(bool ending) const {
  v1::BridgeStatus message = status();
  message.set_ending(ending);
  return message.SerializeAsString();
}

std::string Bridge::scene_bytes() const {
  const std::lock_guard lock(mutex_);
  return scene_;
}

void Bridge::finish() {
  const Clock::time_point deadline = Clock::now() + kFinish;
  const auto is_connected = [this] { return broker_ && broker_->state() == Broker::State::kConnected; };
  do {
    if (is_connected() && is_broker_there()) {
      publish_some(0ms);
    }
  } while (is_connected() && !outbox_.is_empty() && Clock::now() < deadline);
  if (is_connected()) {
    send(subject(options_.host, "status"), status_bytes(true));
  }
  if (!is_connected() || !broker_->flush(1s)) {
    const std::lock_guard lock(mutex_);
    log_("broker: not there at the end; what it was last sent may be lost");
  }
  broker_.reset();
}

}  // namespace haptic::bridge
