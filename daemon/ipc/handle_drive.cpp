#include <chrono>

#include "ipc/handlers.h"

namespace haptic::ipc {
namespace {

constexpr std::chrono::milliseconds kShortestSilence{10};  // a scheduler's hiccup is no death

void fail_without_lease(const Reply& reply) {
  reply.fail(v1::Error::NOT_FOUND, "you do not hold the drive lease");
}

}  // namespace

void handle_acquire_drive(Desk& desk, const Caller& caller, const v1::Request& request, const Reply& reply) {
  if (const auto refusal = desk.lease.refusal(caller.id)) {
    reply.fail(v1::Error::REFUSED, *refusal);
    return;
  }
  const std::chrono::milliseconds longest = desk.lease.longest_silence();
  const std::uint32_t asked = request.acquire_drive().heartbeat_ms();
  const std::chrono::milliseconds silence = asked == 0 ? longest : std::chrono::milliseconds(asked);
  if (silence > longest || silence < kShortestSilence) {
    v1::Error error =
        make_error(v1::Error::INVALID, std::to_string(asked) + " ms are not permitted: from " +
                                           std::to_string(kShortestSilence.count()) + " to " +
                                           std::to_string(longest.count()) +
                                           " ms, which is drive.heartbeat of the daemon's config");
    error.set_field("acquire_drive.heartbeat_ms");
    reply.fail(error);
    return;
  }
  desk.lease.acquire(caller.id, {caller.name, caller.program}, silence, SteadyClock::now());
  v1::Response response;
  response.mutable_drive_lease()->set_heartbeat_ms(static_cast<std::uint32_t>(silence.count()));
  reply.send(std::move(response));
}

void handle_release_drive(Desk& desk, const Caller& caller, const v1::Request& /*request*/,
                          const Reply& reply) {
  if (desk.lease.release(caller.id)) {
    reply.done();
  } else {
    fail_without_lease(reply);
  }
}

void handle_heartbeat(Desk& desk, const Caller& caller, const v1::Request& /*request*/, const Reply& reply) {
  if (desk.lease.beat(caller.id, SteadyClock::now())) {
    reply.done();
  } else {
    fail_without_lease(reply);
  }
}

}  // namespace haptic::ipc
