#pragma once
// Notices what is plugged into the machine, so that a device that comes need not be looked for again and
// again. Each way to devices in drivers/io has one.

#include <vector>

namespace haptic::drivers {

/// For one thread.
class PlugMonitor {
 public:
  virtual ~PlugMonitor() = default;

  /// One of them can be read when there is something to take().
  virtual std::vector<int> descriptors() const = 0;

  /// Takes all notices, without waiting: whether something has come that may be the device.
  virtual bool take() = 0;
};

}  // namespace haptic::drivers
