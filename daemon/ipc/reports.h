#pragma once
// What the daemon tells of itself, for whoever asks: an answer to a client, the numbers for Prometheus, the
// flight recorder. io thread.

#include "haptic/v1/control.pb.h"
#include "ipc/dispatch.h"

namespace haptic::ipc {

v1::Status report_status(const Desk& desk);       // handle_status.cpp
v1::DeviceList report_devices(const Desk& desk);  // handle_devices.cpp
v1::Stats report_stats(const Desk& desk);         // handle_stats.cpp

/// The state that the servo thread has copied: its answer to kCopyState.
v1::WorldState report_state(const servo::Event& answer, const Services& services);  // handle_state.cpp

/// What the state of this scene takes as a message, about.
std::size_t state_bytes(const engine::Scene& scene) noexcept;  // handle_state.cpp

}  // namespace haptic::ipc
