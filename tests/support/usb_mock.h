#pragma once
// A USB device that libusb finds, opens and talks to, without hardware, rights or a kernel driver: umockdev
// hands what libusb asks of the device's node to this file.
//
// What the device does is a UsbFunction. Time is not that of hardware: an exchange costs about a millisecond,
// so tests may wait for what must come, but never measure.

#include <functional>
#include <memory>

#include "tests/support/mock_bus.h"
#include "tests/support/usb_function.h"

namespace haptic::test {

/// The bridge with something behind it, which is called under a lock; the status alone comes every
/// millisecond.
class UsbMock {
 public:
  /// Plugs it in.
  UsbMock(MockBus& bus, const UsbIdentity& identity, UsbFunction function);
  ~UsbMock();
  UsbMock(const UsbMock&) = delete;
  UsbMock& operator=(const UsbMock&) = delete;

  /// From now on the device is gone: transfers in flight fail, new ones are refused.
  void unplug();

  /// The next transfer to the device fails, although it is there.
  void fail_next_out();

  /// Runs `act` between two requests to the device, for what changes or reads what is behind it.
  void with_lock(const std::function<void()>& act);

  struct Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace haptic::test
