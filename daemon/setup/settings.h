#pragma once
// From the checked config to the settings of the parts, the same for the service and the virtual clock.

#include <cstddef>
#include <cstdint>

#include "haptic/v1/config.pb.h"
#include "rt/realtime_thread.h"
#include "servo/servo_loop.h"

namespace haptic::setup {

/// Every field of `config` that has a default must be set, as load_config() does. Nothing is timed and
/// nothing armed.
servo::ServoSettings servo_settings(const v1::DaemonConfig& config);

rt::RealtimeSettings realtime_settings(const v1::Servo& config);

/// What the mailbox reserves for the service.
servo::Capacity snapshot_capacity(const v1::DaemonConfig& config);

/// CLOCK_MONOTONIC, for the times of stages and transitions. Real-time safe.
std::uint64_t stage_clock() noexcept;

}  // namespace haptic::setup
