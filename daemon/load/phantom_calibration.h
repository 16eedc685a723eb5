#pragma once
// The constants of one PHANToM from a file: checked, and complete.

#include <filesystem>
#include <memory>
#include <string>

#include "haptic/v1/calibration.pb.h"
#include "haptic/v1/config.pb.h"
#include "load/text_message.h"

namespace haptic::load {

/// Reads and checks the file; what calibration.proto calls a default is filled in. Throws LoadError.
v1::PhantomCalibration load_phantom_calibration(const std::filesystem::path& file);

/// The same for a message that is already read.
v1::PhantomCalibration check_phantom_calibration(v1::PhantomCalibration message, const TextSource& source);

/// Checks and completes a device that is a PHANToM, which stands at `field` of a message in `file`; returns
/// its calibration. nullptr if it names none, or is another device. Throws LoadError.
std::shared_ptr<const v1::PhantomCalibration> check_phantom(const TextSource& source,
                                                            const std::string& field,
                                                            const std::filesystem::path& file,
                                                            v1::Device& device);

}  // namespace haptic::load
