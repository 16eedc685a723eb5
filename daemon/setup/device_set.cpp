#include "setup/device_set.h"

#include "drivers/registry.h"

namespace haptic::setup {

void require_computed_devices(const load::LoadedConfig& config) {
  for (int i = 0; i < config.message.device_size(); ++i) {
    if (drivers::is_computed(config.message.device(i))) continue;
    config.source.fail(load::item("device", i), "is hardware, which has no virtual clock");
  }
}

DeviceSet::DeviceSet(const load::LoadedConfig& config) {
  for (int i = 0; i < config.message.device_size(); ++i) {
    const v1::Device& device = config.message.device(i);
    const auto index = static_cast<std::size_t>(i);
    owned_.push_back(drivers::make_device(device, config.paths[index], config.firmware[index]));
    pointers_.push_back(owned_.back().get());
    names_.push_back(device.name());
  }
}

DeviceSet::~DeviceSet() { stop(); }

void DeviceSet::start() {
  try {
    for (; started_ < pointers_.size(); ++started_) pointers_[started_]->start();
  } catch (...) {
    stop();
    throw;
  }
}

void DeviceSet::stop() noexcept {
  while (started_ > 0) pointers_[--started_]->stop();
}

}  // namespace haptic::setup
