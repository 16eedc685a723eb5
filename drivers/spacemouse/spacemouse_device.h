#pragma once
// A 3Dconnexion 6-DoF mouse on USB as a device that moves and feels nothing. Its LED is on while it is
// served.

#include <memory>
#include <string>

#include "drivers/device_link.h"
#include "drivers/spacemouse/spacemouse_motion.h"
#include "drivers/threaded_device.h"

namespace haptic::drivers::spacemouse {

struct SpacemouseSettings {
  std::string name;
  std::string serial{};  // empty: the only one
  BasePose world_from_base{};
  MotionSettings motion{};
};

std::unique_ptr<Device> make_spacemouse(SpacemouseSettings settings);

}  // namespace haptic::drivers::spacemouse
