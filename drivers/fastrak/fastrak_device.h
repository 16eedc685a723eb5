#pragma once
// One station of a Polhemus tracker on a serial port, as a device that moves and feels nothing. Up to four
// stations of a FASTRAK are four devices that share the port. It sends at most 120 records a second, fewer
// with more stations on: safety.max_sample_age must be longer than their period.

#include <memory>
#include <string>

#include "drivers/device_link.h"
#include "drivers/fastrak/tracker_line.h"
#include "drivers/threaded_device.h"

namespace haptic::drivers::fastrak {

struct FastrakSettings {
  std::string name;
  LineSettings line;  // the same for all stations of one port
  Station station{};
  BasePose world_from_base{};
};

std::unique_ptr<Device> make_fastrak(FastrakSettings settings);

}  // namespace haptic::drivers::fastrak
