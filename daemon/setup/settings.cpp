#include "setup/settings.h"

#include <utility>
#include <vector>

#include "rt/tick_clock.h"

namespace haptic::setup {

servo::ServoSettings servo_settings(const v1::DaemonConfig& config) {
  const v1::Safety& safety = config.safety();
  std::vector<bool> stops_alone;
  stops_alone.reserve(static_cast<std::size_t>(config.device_size()));
  for (const v1::Device& device : config.device()) {
    stops_alone.push_back(device.on_loss() == v1::Device::STOP_DEVICE);
  }
  return {.rate_hz = config.servo().rate_hz(),
          .limits = {.max_force = safety.max_force(),
                     .max_force_rate = safety.max_force_rate(),
                     .max_speed = safety.max_speed(),
                     .arm_ramp = safety.arm_ramp(),
                     .max_sample_age = safety.max_sample_age()},
          .stops_alone = std::move(stops_alone),
          .max_missed_ticks = safety.max_missed_ticks()};
}

rt::RealtimeSettings realtime_settings(const v1::Servo& config) {
  rt::RealtimeSettings settings{.priority = static_cast<int>(config.priority()),
                                .lock_memory = config.lock_memory()};
  if (config.has_cpu()) settings.cpu = config.cpu();
  return settings;
}

servo::Capacity snapshot_capacity(const v1::DaemonConfig& config) {
  const v1::Capacity& capacity = config.capacity();
  return {.objects = capacity.objects(),
          .fingers = capacity.fingers(),
          .hips = capacity.hips(),
          .contacts = capacity.hips(),
          .devices = static_cast<std::size_t>(config.device_size())};
}

std::uint64_t stage_clock() noexcept { return static_cast<std::uint64_t>(rt::monotonic_ns()); }

}  // namespace haptic::setup
