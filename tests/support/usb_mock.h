#pragma once
// A USB device that libusb finds, opens and talks to, without hardware, rights or a kernel driver: umockdev
// hands what libusb asks of the device's node to this file.
//
// What the device does is a UsbFunction. Time is not that of hardware: an exchange costs about a millisecond,
// so tests may wait for what must come, but never measure.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "tests/support/mock_bus.h"

namespace haptic::test {

/// What the device does; called under a lock.
struct UsbFunction {
  std::function<void(std::uint8_t request, std::uint16_t value)> control;
  std::function<void(std::span<const std::uint8_t>)> out;
  /// At most that many bytes for the host, none if there are none.
  std::function<std::vector<std::uint8_t>(std::size_t)> in;
};

struct UsbIdentity {
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  std::string serial{};  // empty: it has none
  int port = 1;          // 1 to 9; two devices need different ones
};

/// An FTDI bridge with something behind it: two status bytes before each packet, and one of them alone every
/// millisecond while there is nothing to say.
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
