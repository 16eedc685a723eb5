#include "drivers/registry.h"

#include <utility>

#include "drivers/falcon/falcon_device.h"
#include "drivers/playback/playback_device.h"
#include "drivers/simulated/simulated_device.h"

namespace haptic::drivers {

namespace {

/// What the files hold that a config names.
struct Files {
  std::vector<PathPoint> path;
  const std::string& firmware;
};

struct Driver {
  v1::Device::DriverCase driver;
  std::string (*path_file)(const v1::Device& config);  // none: hardware, which follows no path
  std::unique_ptr<Device> (*make)(const v1::Device& config, Files files);
};

BasePose base_of(const v1::Device& config) {
  if (!config.has_base()) return {};
  const v1::Vector3& position = config.base().position();
  const v1::Quaternion& turn = config.base().orientation();
  return {.position = {position.x(), position.y(), position.z()},
          .orientation = {turn.w(), turn.x(), turn.y(), turn.z()}};
}

std::unique_ptr<Device> make_simulated(const v1::Device& config, Files files) {
  const v1::Device::Simulated& simulated = config.simulated();
  SimulatedSettings settings{.name = config.name(),
                             .mass = simulated.mass(),
                             .damping = simulated.damping(),
                             .hand_stiffness = simulated.hand().stiffness(),
                             .hand_damping = simulated.hand().damping(),
                             .path = std::move(files.path),
                             .repeat = simulated.hand().repeat()};
  return std::make_unique<SimulatedDevice>(std::move(settings));
}

std::unique_ptr<Device> make_playback(const v1::Device& config, Files files) {
  return std::make_unique<PlaybackDevice>(config.name(), std::move(files.path), config.playback().repeat());
}

std::unique_ptr<Device> make_falcon(const v1::Device& config, Files files) {
  const v1::Device::Falcon& falcon = config.falcon();
  return falcon::make_falcon({.name = config.name(),
                              .serial = falcon.serial(),
                              .firmware = {files.firmware.begin(), files.firmware.end()},
                              .world_from_base = base_of(config),
                              .control = {.gain = falcon.gain(), .max_force = falcon.max_force()}});
}

constexpr Driver kDrivers[] = {
    {v1::Device::kSimulated, [](const v1::Device& config) { return config.simulated().hand().path(); },
     &make_simulated},
    {v1::Device::kPlayback, [](const v1::Device& config) { return config.playback().path(); },
     &make_playback},
    {v1::Device::kFalcon, nullptr, &make_falcon},
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
  return driver != nullptr && driver->path_file != nullptr ? driver->path_file(config) : std::string();
}

bool is_computed(const v1::Device& config) {
  const Driver* const driver = find_driver(config);
  return driver != nullptr && driver->path_file != nullptr;
}

std::unique_ptr<Device> make_device(const v1::Device& config, std::vector<PathPoint> path,
                                    const std::string& firmware) {
  const Driver* const driver = find_driver(config);
  if (driver == nullptr) {
    throw DeviceError("device \"" + config.name() + "\": it names no driver");
  }
  return driver->make(config, {std::move(path), firmware});
}

}  // namespace haptic::drivers
