#pragma once
// The devices of one config. Their order is that of the config; an index into it is what the rest of the
// daemon calls a device.

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "drivers/device.h"
#include "drivers/virtual/virtual_device.h"
#include "load/config_file.h"

namespace haptic::setup {

/// For the virtual clock: throws load::LoadError, with the place, if a device of the config lives in real
/// time.
void require_computed_devices(const load::LoadedConfig& config);

class DeviceSet {
 public:
  /// Makes the devices. Throws drivers::DeviceError.
  explicit DeviceSet(const load::LoadedConfig& config);
  /// Stops them, if they are started.
  ~DeviceSet();

  DeviceSet(const DeviceSet&) = delete;
  DeviceSet& operator=(const DeviceSet&) = delete;

  /// Starts all of them, or none: throws drivers::DeviceError.
  void start();
  void stop() noexcept;

  std::span<drivers::Device* const> devices() const noexcept { return pointers_; }
  std::span<const std::string> names() const noexcept { return names_; }

  /// The device that clients move, of that index; nullptr if it is of another driver.
  drivers::VirtualDevice* find_virtual(std::size_t index) const noexcept;

 private:
  std::vector<std::unique_ptr<drivers::Device>> owned_;
  std::vector<drivers::Device*> pointers_;
  std::vector<std::string> names_;
  std::size_t started_ = 0;
};

}  // namespace haptic::setup
