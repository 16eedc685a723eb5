#pragma once
// What a config says of limits, workspaces, filters and stops: checked, its defaults filled in.

#include <string>

#include "haptic/v1/config.pb.h"
#include "load/text_message.h"

namespace haptic::load {

/// Checks and completes `safety`. Of max_mean_force and max_still 0 stays: there is no such limit. Throws
/// LoadError.
void check_safety(const TextSource& source, v1::Safety& safety);

/// Checks and completes what `device`, which stands at `field`, says of its limits, workspace and buttons. Of
/// its limits 0 stays: none of its own. Throws LoadError.
void check_device_safety(const TextSource& source, const std::string& field, v1::Device& device);

}  // namespace haptic::load
