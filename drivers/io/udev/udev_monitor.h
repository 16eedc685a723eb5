#pragma once
// Notices what is plugged in by udev's own notices, which come when its rules have set who may open it.

#include <memory>
#include <string>

#include "drivers/plug_monitor.h"

namespace haptic::drivers::io {

/// Of one subsystem of the kernel: "hidraw", "tty". Throws DeviceError.
std::unique_ptr<PlugMonitor> watch_udev(const std::string& subsystem);

}  // namespace haptic::drivers::io
