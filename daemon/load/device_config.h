#pragma once
// What a config says of devices that are hardware: its values checked, its defaults filled in, the files that
// it names read.

#include <cstddef>
#include <filesystem>
#include <string>

#include "haptic/v1/config.pb.h"
#include "load/text_message.h"

namespace haptic::load {

/// No firmware is larger; that of a Falcon has 8492 bytes at most.
inline constexpr std::size_t kMaxFirmwareBytes = 65536;

/// The drivers that the schema has, as an error lists them: "simulated, playback, ...".
std::string known_drivers();

/// The name of the driver in the schema, e.g. "falcon"; empty if the device has none.
std::string driver_name(const v1::Device& device);

/// Checks and completes `device`, which stands at `field` of a message in `file`; nothing for a device that
/// is computed, but that it has no base. Returns the firmware that its driver uploads, empty if none. Throws
/// LoadError.
std::string check_hardware(const TextSource& source, const std::string& field,
                           const std::filesystem::path& file, v1::Device& device);

/// SHA-256 of the bytes, in lower-case hexadecimal.
std::string sha256(const std::string& bytes);

}  // namespace haptic::load
