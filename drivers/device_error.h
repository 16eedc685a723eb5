#pragma once
// What a driver throws, before the servo thread runs or beside it.

#include <stdexcept>

namespace haptic::drivers {

/// A device cannot be made, opened or started; the message tells a person why, and how to mend it.
class DeviceError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// It is not connected: plugging it in mends that.
class DeviceAbsent : public DeviceError {
 public:
  using DeviceError::DeviceError;
};

}  // namespace haptic::drivers
