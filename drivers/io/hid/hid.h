#pragma once
// HID devices by hidapi, over hidraw: finding, opening, reports. It knows nothing of any device.
//
// One thread uses an open device at a time. Functions throw DeviceError. Not real-time safe.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

namespace haptic::drivers::io {

/// One interface of a device that is connected.
struct HidInfo {
  std::string path;
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  int interface_number = -1;
  std::uint16_t usage_page = 0;
  std::uint16_t usage = 0;
  std::string serial;
};

/// The one interface that `matches`; `what` names it in the error: DeviceAbsent if there is none, DeviceError
/// with their serials if there are more.
HidInfo find_hid(const std::string& what, const std::function<bool(const HidInfo&)>& matches);

class HidDevice {
 public:
  explicit HidDevice(const HidInfo& info);
  ~HidDevice();

  HidDevice(const HidDevice&) = delete;
  HidDevice& operator=(const HidDevice&) = delete;

  /// One report, with its id first if the device numbers them; 0 if `timeout` passes without one.
  std::size_t read(std::span<std::uint8_t> report, std::chrono::milliseconds timeout);

  /// Sends a report, its id first: 0 if the device does not number them.
  void write(std::span<const std::uint8_t> report);

  /// The same for feature reports.
  void send_feature(std::span<const std::uint8_t> report);
  std::size_t get_feature(std::span<std::uint8_t> report);

 private:
  struct Handle;
  std::unique_ptr<Handle> handle_;
};

}  // namespace haptic::drivers::io
