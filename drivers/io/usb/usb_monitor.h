#pragma once
// Notices USB devices that are plugged in, by libusb's hot-plug notices.

#include <cstdint>
#include <memory>

#include "drivers/plug_monitor.h"

namespace haptic::drivers::io {

/// Of one kind of device; nullptr where libusb has no such notices. Throws DeviceError.
std::unique_ptr<PlugMonitor> watch_usb(std::uint16_t vendor, std::uint16_t product);

}  // namespace haptic::drivers::io
