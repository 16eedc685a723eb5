#pragma once
// Values of the schema's enumerations as the words that machines are told: labels of numbers, fields of logs,
// names of files. They stay for good.

#include <string>

#include "haptic/v1/control.pb.h"

namespace haptic::metrics {

/// FAULT_OVER_SPEED: "over_speed"; of one that this program does not know "fault_77".
std::string word_of(v1::FaultKind kind);

/// DEVICE_READY: "ready"; "unknown" of none.
std::string word_of(v1::DevicePhase phase);

}  // namespace haptic::metrics
