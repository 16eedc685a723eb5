#pragma once
// A device that another program on this machine serves, over a local socket: one that has its maker's closed
// library, say. The program sends a sample each millisecond and is answered with the newest force, which
// expires by itself 3 ms later (proto/device/haptic_device.h).
//
// One program at a time, of a user who may. Whoever sends what is no message, or nothing for kSilence, is
// told why and cut off; then there is no sample any more, and the servo takes the device for gone. The next
// program is let in kPause later, so that its pose is never taken for a move of the former one's.

#include <chrono>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "drivers/device.h"
#include "drivers/device_link.h"

namespace haptic::drivers::external {

inline constexpr std::chrono::milliseconds kSilence{1000};
inline constexpr std::chrono::milliseconds kPause{100};

struct ExternalSettings {
  std::string name;
  std::string path;                                            // of the socket
  std::vector<std::string> users{};                            // beside root and the daemon's own
  double max_force = std::numeric_limits<double>::infinity();  // N
  BasePose world_from_base{};
};

/// Its start() throws DeviceError if the socket cannot be made, or a user is none.
std::unique_ptr<Device> make_external(const ExternalSettings& settings);

}  // namespace haptic::drivers::external
