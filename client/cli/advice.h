#pragma once
// What a person can do about a fault.

#include <string>

#include "haptic/v1/device.pb.h"

namespace haptic::cli {

/// One sentence or two, from "see that ..." on.
std::string advise(v1::FaultKind kind);

}  // namespace haptic::cli
