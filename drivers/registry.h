#pragma once
// From a device in the config to a Device: the one place that knows every driver. A new driver is one row in
// the table of registry.cpp.

#include <memory>
#include <string>
#include <vector>

#include "drivers/device.h"
#include "drivers/device_error.h"
#include "drivers/path.h"
#include "haptic/v1/config.pb.h"

namespace haptic::v1 {
class PhantomCalibration;
}

namespace haptic::drivers {

/// The file with the path that the device follows, as the config names it; empty if it follows none.
std::string path_file_of(const v1::Device& config);

/// Whether the device is computed, and so runs on a virtual clock too; false for what lives in real time.
bool is_computed(const v1::Device& config);

/// A device that is not yet started. `path` holds the rows of path_file_of(), `firmware` the bytes that its
/// driver uploads, `calibration` the checked constants of a PHANToM, if there are any. The config must be
/// valid and complete but for its driver: throws DeviceError if it names none that is known here.
std::unique_ptr<Device> make_device(const v1::Device& config, std::vector<PathPoint> path,
                                    const std::string& firmware = {},
                                    const v1::PhantomCalibration* calibration = nullptr);

}  // namespace haptic::drivers
