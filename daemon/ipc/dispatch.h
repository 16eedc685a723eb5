#pragma once
// From a request to what handles it. The table in dispatch.cpp is the only place that says which call needs
// which role, and it is asked before anything else is done. io thread.

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>

#include "ipc/device_moves.h"
#include "ipc/drive_lease.h"
#include "ipc/fault_history.h"
#include "ipc/publisher.h"
#include "ipc/reply.h"
#include "ipc/scene_store.h"
#include "ipc/services.h"
#include "ipc/servo_link.h"

namespace haptic::ipc {

/// Who asks.
struct Caller {
  ClientId id = 0;
  v1::Role role = v1::ROLE_UNSPECIFIED;
  std::string name;                                  // for others to read
  std::string program;                               // that it calls itself, fit to be printed
  std::size_t subscriptions = 16;                    // that it can have
  std::size_t answer_bytes = std::size_t{4} << 20U;  // the largest answer that can be sent to it
  FrameSink sink;                                    // for its subscriptions
  std::function<void(std::uint32_t)> drop_frames;    // of a subscription that has ended
};

/// What handlers work with.
struct Desk {
  Services& services;
  ServoLink& servo;
  SceneStore& scenes;
  Publisher& publisher;
  SteadyClock::time_point started;
  std::function<std::size_t()> count_clients;
  DriveLease& lease;
  DeviceMoves moves{};
  FaultHistory faults{};
};

/// The least role that the request needs; ROLE_UNSPECIFIED if this daemon does not know the call.
v1::Role least_role(const v1::Request& request) noexcept;

/// Answers the request, now or later, exactly once.
void dispatch(Desk& desk, const Caller& caller, const v1::Request& request, const Reply& reply);

}  // namespace haptic::ipc
