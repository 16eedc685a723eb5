#include "setup/settings.h"

#include <utility>
#include <vector>

#include "rt/tick_clock.h"

namespace haptic::setup {

namespace {

glm::dvec3 vector_of(const v1::Vector3& v) { return {v.x(), v.y(), v.z()}; }

/// 0 stands for a limit that there is not.
double or_unlimited(double limit) { return limit == 0.0 ? safety::kUnlimited : limit; }

safety::DeviceLimits limits_of(const v1::Device::Limits& limits) {
  safety::DeviceLimits own{.max_force = or_unlimited(limits.max_force()),
                           .max_force_rate = or_unlimited(limits.max_force_rate()),
                           .max_speed = or_unlimited(limits.max_speed()),
                           .max_mean_force = or_unlimited(limits.max_mean_force()),
                           .max_energy = or_unlimited(limits.max_energy())};
  if (limits.has_travel()) {
    own.travel = {vector_of(limits.travel().min()), vector_of(limits.travel().max())};
  }
  return own;
}

servo::MotionFilterKind kind_of(v1::Device::MotionFilter::Kind kind) {
  switch (kind) {
    case v1::Device::MotionFilter::ADAPTIVE_WINDOW:
      return servo::MotionFilterKind::kAdaptiveWindow;
    case v1::Device::MotionFilter::LOW_PASS:
      return servo::MotionFilterKind::kLowPass;
    default:
      return servo::MotionFilterKind::kDriver;
  }
}

servo::DeviceSettings device_settings(const v1::Device& device) {
  const v1::Device::Workspace& workspace = device.workspace();
  servo::DeviceSettings settings{
      .limits = limits_of(device.limits()),
      .workspace = {.scale = workspace.scale(), .force_scale = workspace.force_scale()},
      .filter = {.kind = kind_of(workspace.filter().kind()),
                 .window = workspace.filter().window(),
                 .noise = workspace.filter().noise(),
                 .cutoff = workspace.filter().cutoff()}};
  if (device.has_base()) {
    const v1::Quaternion& turn = device.base().orientation();
    settings.workspace.world_from_base = {vector_of(device.base().position()),
                                          {turn.w(), turn.x(), turn.y(), turn.z()}};
  }
  if (workspace.has_clutch_button()) settings.workspace.clutch_button = workspace.clutch_button();
  if (device.has_stop_button()) settings.stop_button = device.stop_button();
  settings.stops_alone = device.on_loss() == v1::Device::STOP_DEVICE;
  return settings;
}

}  // namespace

servo::ServoSettings servo_settings(const v1::DaemonConfig& config) {
  const v1::Safety& safety = config.safety();
  std::vector<servo::DeviceSettings> devices;
  devices.reserve(static_cast<std::size_t>(config.device_size()));
  for (const v1::Device& device : config.device()) devices.push_back(device_settings(device));
  return {.rate_hz = config.servo().rate_hz(),
          .limits = {.max_force = safety.max_force(),
                     .max_force_rate = safety.max_force_rate(),
                     .max_speed = safety.max_speed(),
                     .arm_ramp = safety.arm_ramp(),
                     .max_sample_age = safety.max_sample_age(),
                     .max_mean_force = or_unlimited(safety.max_mean_force()),
                     .mean_force_time = safety.mean_force_time(),
                     .max_energy = safety.max_energy(),
                     .max_arm_force = safety.max_arm_force(),
                     .max_still = or_unlimited(safety.max_still())},
          .devices = std::move(devices),
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
