#pragma once
// The daemon's own values as messages of the schema.

#include <span>
#include <string>

#include "haptic/v1/control.pb.h"
#include "servo/mailbox.h"

namespace haptic::ipc {

v1::ConstraintState to_wire(engine::ConstraintState state) noexcept;
v1::FaultKind to_wire(safety::FaultKind kind) noexcept;

v1::DevicePhase to_wire(drivers::DevicePhase phase) noexcept;

/// Where the device stands for a client: a fault or being armed counts once the device itself is ready.
v1::DevicePhase phase_of(const servo::DeviceSnapshot& device) noexcept;

/// Names the device, where the fault is one device's.
v1::Fault to_wire(const safety::Fault& fault, std::span<const v1::DeviceDescription> devices);

/// "left: over speed, 2.31 m/s where 2 m/s is allowed"
std::string in_words(const v1::Fault& fault);

v1::Histogram to_wire(const std::string& name, const rt::LatencyHistogram& histogram);

/// Lists every permitted transition, those that were not made with count 0.
v1::Stats to_wire(const servo::LoopStats& stats, double rate_hz, std::uint64_t lost_snapshots);

v1::Error make_error(v1::Error::Code code, const std::string& message);

}  // namespace haptic::ipc
