#include "drivers/registry.h"

#include <utility>

#include "drivers/playback/playback_device.h"
#include "drivers/simulated/simulated_device.h"

namespace haptic::drivers {

namespace {

struct Driver {
  v1::Device::DriverCase driver;
  std::string (*path_file)(const v1::Device& config);
  std::unique_ptr<Device> (*make)(const v1::Device& config, std::vector<PathPoint> path);
};

std::unique_ptr<Device> make_simulated(const v1::Device& config, std::vector<PathPoint> path) {
  const v1::Device::Simulated& simulated = config.simulated();
  SimulatedSettings settings{.name = config.name(),
                             .mass = simulated.mass(),
                             .damping = simulated.damping(),
                             .hand_stiffness = simulated.hand().stiffness(),
                             .hand_damping = simulated.hand().damping(),
                             .path = std::move(path),
                             .repeat = simulated.hand().repeat()};
  return std::make_unique<SimulatedDevice>(std::move(settings));
}

std::unique_ptr<Device> make_playback(const v1::Device& config, std::vector<PathPoint> path) {
  return std::make_unique<PlaybackDevice>(config.name(), std::move(path), config.playback().repeat());
}

constexpr Driver kDrivers[] = {
    {v1::Device::kSimulated, [](const v1::Device& config) { return config.simulated().hand().path(); },
     &make_simulated},
    {v1::Device::kPlayback, [](const v1::Device& config) { return config.playback().path(); },
     &make_playback},
};

const Driver* find_driver(const v1::Device& config) {
  for (const Driver& row : kDrivers) {
    if (row.driver == config.driver_case()) return &row;
  }
  return nullptr;
}

}  // namespace

std::string path_file_of(const v1::Device& config) {
  const Driver* const driver = find_driver(config);
  return driver != nullptr ? driver->path_file(config) : std::string();
}

std::unique_ptr<Device> make_device(const v1::Device& config, std::vector<PathPoint> path) {
  const Driver* const driver = find_driver(config);
  if (driver == nullptr) {
    throw DeviceError("device \"" + config.name() + "\": no driver is named; known are simulated, playback");
  }
  return driver->make(config, std::move(path));
}

}  // namespace haptic::drivers
