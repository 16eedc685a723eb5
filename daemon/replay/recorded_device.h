#pragma once
// A device that measures what a recording says. It has no time of its own: a sample that was fresh is of the
// tick that asks, and any other is so old that it counts as none. Forces on it go nowhere.

#include <limits>
#include <string>
#include <utility>

#include "drivers/device.h"

namespace haptic::replay {

class RecordedDevice final : public drivers::Device {
 public:
  explicit RecordedDevice(std::string name)
      : info_{.name = std::move(name),
              .driver = "replay",
              .max_force = std::numeric_limits<double>::infinity()} {}

  /// What the next read() measures; m, m/s, world. `fresh`: the recorded tick used it.
  void measure(const drivers::DeviceSample& sample, bool fresh) noexcept;

  const drivers::DeviceInfo& info() const noexcept override { return info_; }
  void start() override {}
  void stop() noexcept override {}
  bool read(drivers::Nanoseconds now, drivers::DeviceSample& sample) noexcept override;
  void write(drivers::Nanoseconds now, const drivers::ForceCommand& command) noexcept override;

 private:
  drivers::DeviceInfo info_;
  drivers::DeviceSample sample_{};
  bool fresh_ = false;
};

}  // namespace haptic::replay
