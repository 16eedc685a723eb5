#include "drivers/playback/playback_device.h"

#include <limits>
#include <utility>

namespace haptic::drivers {

PlaybackDevice::PlaybackDevice(std::string name, std::vector<PathPoint> path, bool repeat)
    : info_{.name = std::move(name),
            .driver = "playback",
            .max_force = std::numeric_limits<double>::infinity(),
            .exerts_force = false},
      path_(std::move(path)),
      repeat_(repeat) {}

void PlaybackDevice::start() {
  running_ = true;
  timed_ = false;
}

void PlaybackDevice::stop() noexcept { running_ = false; }

bool PlaybackDevice::read(Nanoseconds now, DeviceSample& device_sample) noexcept {
  if (!running_) return false;
  if (!timed_) start_time_ = now;
  timed_ = true;
  const PathSample at = sample(path_, static_cast<double>(now - start_time_) * 1e-9, repeat_);
  device_sample = {.time = now,
                   .position = at.position,
                   .orientation = at.orientation,
                   .velocity = at.velocity,
                   .buttons = 0};
  return true;
}

void PlaybackDevice::write(Nanoseconds /*now*/, const ForceCommand& /*command*/) noexcept {}

}  // namespace haptic::drivers
