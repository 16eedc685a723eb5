#include "ipc/handlers.h"

namespace haptic::ipc {

void handle_subscribe(Desk& desk, const Caller& caller, const v1::Request& request, const Reply& reply) {
  TopicSet topics = 0;
  for (const int topic : request.subscribe().topic()) {
    if (topic < v1::OBJECTS || topic > v1::DEVICES) {
      v1::Error error = make_error(v1::Error::INVALID,
                                   "there is no topic " + std::to_string(topic) + "; OBJECTS, HIPS, DEVICES");
      error.set_field("subscribe.topic");
      reply.fail(error);
      return;
    }
    topics |= topic_bit(static_cast<v1::Topic>(topic));
  }
  if (topics == 0) {
    v1::Error error = make_error(v1::Error::INVALID, "at least one topic is needed: OBJECTS, HIPS, DEVICES");
    error.set_field("subscribe.topic");
    reply.fail(error);
    return;
  }
  if (desk.publisher.subscriptions_of(caller.id) >= caller.subscriptions) {
    reply.fail(v1::Error::BUSY, "a client can have " + std::to_string(caller.subscriptions) +
                                    " subscriptions; end one of them");
    return;
  }
  v1::Response response;
  response.mutable_subscribed()->set_subscription(
      desk.publisher.subscribe(caller.id, topics, request.subscribe().decimation(), caller.sink));
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
