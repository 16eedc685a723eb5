#pragma once
// An arm of the WoodenHaptics family, on USB (HID), or for its position alone on UDP.

#include <cstdint>
#include <memory>
#include <string>

#include "drivers/device_link.h"
#include "drivers/polhem/polhem_control.h"
#include "drivers/threaded_device.h"

namespace haptic::drivers::polhem {

struct PolhemSettings {
  std::string name;
  std::uint16_t vendor = 0x16c0;  // of the USB device
  std::uint16_t product = 0x0486;
  std::uint16_t udp_port = 0;  // if not 0: UDP instead of USB
  BasePose world_from_base{};
  ControlSettings control{};
};

std::unique_ptr<Device> make_polhem(PolhemSettings settings);

}  // namespace haptic::drivers::polhem
