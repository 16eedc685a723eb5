#pragma once
// The checks, each of one thing: they look at a machine and add what they find. None changes anything.

#include "client/doctor/finding.h"
#include "client/doctor/machine.h"
#include "haptic/v1/config.pb.h"

namespace haptic::doctor {

/// The kernel, limits of real time, throttling, clock, governor, sleep states, the servo's core and its
/// interrupts.
void check_real_time(const Machine& machine, const v1::Servo& servo, Findings& findings);

/// Whether the device can be opened, by whom it is held, and what delays it. Its paths are absolute.
void check_device(const Machine& machine, const v1::Device& device, Findings& findings);

/// Known devices that are connected, for a machine without a config.
void check_connected(const Machine& machine, Findings& findings);

/// Where the daemon listens.
void check_sockets(const Machine& machine, const v1::DaemonConfig& config, Findings& findings);

}  // namespace haptic::doctor
