#include "setup/device_set.h"

#include "drivers/registry.h"
#include "load/text_message.h"

namespace haptic::setup {

void require_computed_devices(const load::LoadedConfig& config) {
  for (int i = 0; i < config.message.device_size(); ++i) {
    if (drivers::is_computed(config.message.device(i))) continue;
    config.source.fail(load::item("device", i), "lives in real time: it cannot follow a virtual clock");
  }
}

DeviceSet::DeviceSet(const load::LoadedConfig& config) {
  for (int i = 0; i < config.message.device_size(); ++i) {
    const v1::Device& device = config.message.device(i);
    const auto index = static_cast<std::size_t>(i);
    owned_.push_back(drivers::make_device(device, config.paths[index], config.firmware[index],
                                          config.calibrations[index].get()));
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

drivers::VirtualDevice* DeviceSet::find_virtual(std::size_t index) const noexcept {
  return dynamic_cast<drivers::VirtualDevice*>(pointers_[index]);
}

}  // namespace haptic::setup
