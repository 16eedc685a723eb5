#pragma once
// What is told, whatever the way to them, of devices that cannot be told apart, and of those that this user
// may not open.

#include <algorithm>
#include <string>
#include <vector>

#include "drivers/device_error.h"

namespace haptic::drivers::io {

/// How to get the permission that a udev rule gives.
inline const std::string kUdevRemedy =
    "udev's rule 70-hapticd.rules gives it to the group plugdev: install that rule, let the user who runs "
    "hapticd join the group, then plug the device in again";

/// Throws DeviceError. `what` names them; several are connected with these serials, of which some may be
/// empty.
[[noreturn]] inline void fail_same_kind(const std::string& what, std::vector<std::string> serials) {
  std::sort(serials.begin(), serials.end());
  const auto nameless = std::count(serials.begin(), serials.end(), std::string());
  std::string told = std::to_string(serials.size()) + " " + what + " are connected";
  if (static_cast<std::size_t>(nameless) == serials.size()) {
    throw DeviceError(told + ", and have no serial by which to tell them apart: leave only one plugged in");
  }
  told += ", with the serials ";
  for (std::size_t i = 0; i < serials.size(); ++i) {
    if (i > 0) told += i + 1 == serials.size() ? " and " : ", ";
    told += serials[i].empty() ? "(none)" : serials[i];
  }
  throw DeviceError(told + ": name the one that is meant by its serial");
}

}  // namespace haptic::drivers::io
