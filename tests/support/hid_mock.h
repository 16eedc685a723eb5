#pragma once
// A HID device that hidapi finds, opens and talks to over an emulated hidraw node.

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "tests/support/mock_bus.h"

namespace haptic::test {

struct HidIdentity {
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  int interface_number = 0;
  std::uint8_t usage_page = 1;
  std::uint8_t usage = 8;
  std::string serial{};
  int port = 1;  // 1 to 9; interfaces of one device have the same
  int node = 0;  // of /dev/hidraw<node>
};

/// What the device does with what it is told; each may be empty. Called under a lock.
struct HidFunction {
  std::function<void(std::span<const std::uint8_t>)> out{};
  std::function<void(std::span<const std::uint8_t>)> set_feature{};
};

class HidMock {
 public:
  /// Plugs it in.
  HidMock(MockBus& bus, const HidIdentity& identity, HidFunction function = {});
  ~HidMock();
  HidMock(const HidMock&) = delete;
  HidMock& operator=(const HidMock&) = delete;

  /// The device sends a report.
  void send(std::span<const std::uint8_t> report);

  /// From now on the device is gone.
  void unplug();

  /// Runs `act` between two requests to the device.
  void with_lock(const std::function<void()>& act);

  struct Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace haptic::test
