#pragma once
// Waiting for where a device gets to in its life.

#include <string>

#include "drivers/device.h"
#include "tests/support/eventually.h"

namespace haptic::test {

/// Whether it gets there within 20 s.
inline bool reaches(const drivers::Device& device, drivers::DevicePhase phase) {
  return eventually([&] { return device.state().phase == phase; });
}

/// Waits until it has been looked for and is not there, or cannot be opened: why. Empty if it is opened.
inline std::string why_not_open(const drivers::Device& device) {
  std::string reason;
  (void)eventually([&] {
    reason = device.words().reason;
    const drivers::DevicePhase phase = device.state().phase;
    if (phase >= drivers::DevicePhase::kHoming) reason.clear();
    return phase >= drivers::DevicePhase::kHoming ||
           (phase != drivers::DevicePhase::kOpening && reason != "it is looked for");
  });
  return reason;
}

}  // namespace haptic::test
