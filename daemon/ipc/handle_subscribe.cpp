#include <optional>
#include <set>
#include <string_view>

#include "ipc/handlers.h"

namespace haptic::ipc {
namespace {

// a client that names more wants all
constexpr int kNames = 1024;

constexpr const char* kTopicNames = "OBJECTS, HIPS, DEVICES, EVENTS, STATS, INPUTS";

v1::Error wrong(v1::Error::Code code, const std::string& field, const std::string& message) {
  v1::Error error = make_error(code, message);
  error.set_field("subscribe." + field);
  return error;
}

std::optional<v1::Error> check_choices(const v1::Subscribe& request) {
  for (const int topic : request.topic()) {
    if (topic == v1::TOPIC_UNSPECIFIED || !v1::Topic_IsValid(topic)) {
      return wrong(v1::Error::INVALID, "topic",
                   "there is no topic " + std::to_string(topic) + "; " + kTopicNames);
    }
  }
  if (request.topic().empty()) {
    return wrong(v1::Error::INVALID, "topic", std::string("at least one topic is needed: ") + kTopicNames);
  }
  if (!v1::Delivery_IsValid(request.delivery())) {
    return wrong(v1::Error::INVALID, "delivery",
                 "there is no delivery " + std::to_string(request.delivery()) + "; LATEST, LOSSLESS");
  }
  return std::nullopt;
}

// `there`: what of the scene has names
template <class Described>
std::optional<v1::Error> check_names(const google::protobuf::RepeatedPtrField<std::string>& wanted,
                                     const Described& there, const std::string& kind) {
  if (wanted.size() > kNames) {
    return wrong(v1::Error::INVALID, kind,
                 std::to_string(wanted.size()) + " names; at most " + std::to_string(kNames) + " are taken");
  }
  std::set<std::string_view> names;
  for (const auto& described : there) {
    names.insert(described.name());
  }
  for (int i = 0; i < wanted.size(); ++i) {
    if (!names.contains(wanted[i])) {
      return wrong(v1::Error::NOT_FOUND, kind + "[" + std::to_string(i) + "]",
                   "the scene has no " + kind + " \"" + wanted[i] + "\"");
    }
  }
  return std::nullopt;
}

}  // namespace

void handle_subscribe(Desk& desk, const Caller& caller, const v1::Request& request, const Reply& reply) {
  const v1::Subscribe& wanted = request.subscribe();
  const v1::SceneDescription& scene = desk.scenes.current();
  std::optional<v1::Error> error = check_choices(wanted);
  if (!error) {
    error = check_names(wanted.finger(), scene.finger(), "finger");
  }
  if (!error) {
    error = check_names(wanted.object(), scene.object(), "object");
  }
  if (error) {
    reply.fail(*error);
    return;
  }
  if (desk.publisher.subscriptions_of(caller.id) >= caller.subscriptions) {
    reply.fail(v1::Error::BUSY, "a client can have " + std::to_string(caller.subscriptions) +
                                    " subscriptions; end one of them");
    return;
  }
  Wish wish{.topics = 0,
            .decimation = wanted.decimation(),
            .delivery = wanted.delivery(),
            .filter = filter_of(wanted)};
  for (const int topic : wanted.topic()) {
    wish.topics |= topic_bit(static_cast<v1::Topic>(topic));
  }
  v1::Response response;
  response.mutable_subscribed()->set_subscription(desk.publisher.subscribe(caller.id, wish, caller.sink));
  reply.send(std::move(response));
}

void handle_unsubscribe(Desk& desk, const Caller& caller, const v1::Request& request, const Reply& reply) {
  const std::uint32_t subscription = request.unsubscribe().subscription();
  if (!desk.publisher.unsubscribe(caller.id, subscription)) {
    reply.fail(v1::Error::NOT_FOUND, "you have no subscription " + std::to_string(subscription));
    return;
  }
  caller.drop_frames(subscription);
  reply.done();
}

}  // namespace haptic::ipc
