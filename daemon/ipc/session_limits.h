#pragma once
// How much of the daemon one client can take.

#include <chrono>
#include <cstddef>
#include <cstdint>

#include "ipc/outbox.h"
#include "proto/protocol.h"

namespace haptic::ipc {

struct SessionLimits {
  std::chrono::milliseconds hello{5000};    // from connecting to the client's hello
  std::chrono::milliseconds goodbye{1000};  // for the client to take its goodbye
  std::size_t greeting_bytes = proto::kGreetingLimit;
  std::size_t request_bytes = proto::kRequestLimit;
  std::size_t open_requests = 32;            // without an answer yet
  std::uint32_t requests_per_second = 2000;  // and as many in a burst (request_rate.h)
  std::size_t subscriptions = 16;
  std::size_t items = 16384;  // of one list in a message
  OutboxLimits outbox;
};

}  // namespace haptic::ipc
