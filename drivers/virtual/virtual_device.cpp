#include "drivers/virtual/virtual_device.h"

#include <limits>
#include <utility>

namespace haptic::drivers {

VirtualDevice::VirtualDevice(std::string name)
    : info_{.name = std::move(name),
            .driver = "virtual",
            .max_force = std::numeric_limits<double>::infinity()},
      velocity_(kVelocityLag) {}

void VirtualDevice::place(DeviceSample sample, bool tells_velocity) noexcept {
  const glm::dvec3& estimate = velocity_.take(sample.time, sample.position);
  if (!tells_velocity) sample.velocity = estimate;
  link_.publish(sample);
}

bool VirtualDevice::read(Nanoseconds /*now*/, DeviceSample& sample) noexcept { return link_.read(sample); }

void VirtualDevice::write(Nanoseconds now, const ForceCommand& command) noexcept {
  link_.write(now, command);
}

}  // namespace haptic::drivers
