#pragma once
// The daemon's config, checked and complete: what haptic/v1/config.proto calls a default is filled in, paths
// are relative to nothing any more, and the paths that devices follow, the firmware that they need and their
// calibrations are read.

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "drivers/path.h"
#include "haptic/v1/config.pb.h"
#include "load/text_message.h"

namespace haptic::v1 {
class PhantomCalibration;
}

namespace haptic::load {

/// Devices that one daemon serves.
inline constexpr int kMostDevices = 16;

struct LoadedConfig {
  v1::DaemonConfig message;  // every field set that has a default; paths absolute or relative to the process
  std::vector<std::vector<drivers::PathPoint>> paths;  // one for each device, in order; empty if it has none
  std::vector<std::string> firmware;  // the same for the bytes of the firmware that a device's driver uploads
  std::vector<std::shared_ptr<const v1::PhantomCalibration>> calibrations;  // the same; nullptr: none
  TextSource source;                                                        // where the fields stand
};

/// Reads and checks the file, and the CSV files that it names. Throws LoadError. The scene that it names is
/// not read.
LoadedConfig load_config(const std::filesystem::path& file);

/// The same for a message from memory; relative paths are taken relative to the folder of `file`.
LoadedConfig check_config(v1::DaemonConfig message, const TextSource& source,
                          const std::filesystem::path& file);

/// What scenes may hold if no config says otherwise.
v1::Capacity default_capacity();

}  // namespace haptic::load
