#pragma once
// A Novint Falcon on USB: brings its firmware up, then exchanges packets with it at 1 kHz on a thread of its
// own, what falcon_control.h decides in them. Zero-force packets go out on every way out.
//
//     thread of the device, each millisecond:   live force --> next_packet() --> USB out, never waited for
//     whenever a reply comes in between:        USB in --> take() --> sample to the servo

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "drivers/device_link.h"
#include "drivers/falcon/falcon_control.h"
#include "drivers/falcon/falcon_firmware.h"
#include "drivers/threaded_device.h"

namespace haptic::drivers::falcon {

struct FalconSettings {
  std::string name;
  std::string serial{};                  // of the USB device; empty: the only one
  std::vector<std::uint8_t> firmware{};  // empty: it must already run
  BasePose world_from_base{};
  ControlSettings control{};
  BootLimits boot{};
};

std::unique_ptr<Device> make_falcon(FalconSettings settings);

}  // namespace haptic::drivers::falcon
