#pragma once
// A device that follows a path whatever force is applied: for repeatable measurements. Computed in read(),
// without a thread; real-time safe.

#include <string>
#include <vector>

#include "drivers/device.h"
#include "drivers/path.h"

namespace haptic::drivers {

class PlaybackDevice final : public Device {
 public:
  /// Time 0 of the path is the first read() after start().
  PlaybackDevice(std::string name, std::vector<PathPoint> path, bool repeat);

  const DeviceInfo& info() const noexcept override { return info_; }
  void start() override;
  void stop() noexcept override;
  bool read(Nanoseconds now, DeviceSample& sample) noexcept override;
  void write(Nanoseconds now, const ForceCommand& command) noexcept override;

 private:
  DeviceInfo info_;
  std::vector<PathPoint> path_;
  bool repeat_;
  bool running_ = false;
  bool timed_ = false;  // start_time_ is set
  Nanoseconds start_time_ = 0;
};

}  // namespace haptic::drivers
