#pragma once
// One wand of a Razer Hydra as a device that moves and feels nothing. The other wand is another device: both
// may be served at once.

#include <chrono>
#include <cstddef>
#include <memory>
#include <string>

#include "drivers/device_link.h"
#include "drivers/threaded_device.h"

namespace haptic::drivers::hydra {

struct HydraSettings {
  std::string name;
  std::size_t wand = 0;  // 0 or 1
  BasePose world_from_base{};
  std::chrono::milliseconds first_report{1000};  // it may already send motion
  std::chrono::milliseconds mode_change{5000};   // until the first report after asking for it
  int attempts = 3;
};

std::unique_ptr<Device> make_hydra(HydraSettings settings);

}  // namespace haptic::drivers::hydra
