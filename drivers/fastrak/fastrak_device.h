#pragma once
// One station of a Polhemus FASTRAK on a serial port, as a device that moves and feels nothing. It sends at
// most 120 records a second, fewer with more stations on: safety.max_sample_age must be longer than their
// period.

#include <chrono>
#include <memory>
#include <string>

#include "drivers/device_link.h"
#include "drivers/threaded_device.h"

namespace haptic::drivers::fastrak {

struct FastrakSettings {
  std::string name;
  std::string port;  // e.g. "/dev/ttyUSB0"
  unsigned baud = 115200;
  int station = 1;                       // 1 to 4
  glm::dvec3 hemisphere{1.0, 0.0, 0.0};  // from the transmitter towards where the receiver moves
  BasePose world_from_base{};
  std::chrono::milliseconds settle{2000};   // after it was told to be silent
  std::chrono::milliseconds command{50};    // after each command
  std::chrono::milliseconds silence{1500};  // without a record: it is started again
};

std::unique_ptr<Device> make_fastrak(FastrakSettings settings);

}  // namespace haptic::drivers::fastrak
