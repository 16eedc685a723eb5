#include "replay/recorded_device.h"

namespace haptic::replay {

namespace {

constexpr drivers::Nanoseconds kLongAgo = 3'600'000'000'000;  // an hour: no sample may be this old

}  // namespace

void RecordedDevice::measure(const drivers::DeviceSample& sample, bool fresh) noexcept {
  sample_ = sample;
  fresh_ = fresh;
}

bool RecordedDevice::read(drivers::Nanoseconds now, drivers::DeviceSample& sample) noexcept {
  sample = sample_;
  sample.time = fresh_ ? now : now - kLongAgo;
  return true;
}

void RecordedDevice::write(drivers::Nanoseconds /*now*/, const drivers::ForceCommand& /*command*/) noexcept {}

}  // namespace haptic::replay
