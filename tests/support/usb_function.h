#pragma once
// An emulated USB device, whichever way its host reaches it: an FTDI bridge with something behind it. Two
// status bytes come before the data of each packet, and alone while there is nothing to say.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace haptic::test {

/// What is behind the bridge.
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

inline constexpr std::size_t kUsbPacketBytes = 64;
inline constexpr std::size_t kUsbStatusBytes = 2;

/// How many of the bytes of usb_descriptors() are the device's own; the others are its configuration's.
inline constexpr std::size_t kUsbDeviceDescriptorBytes = 18;

/// Device, configuration, one vendor interface, bulk in 0x81 and out 0x02.
std::vector<std::uint8_t> usb_descriptors(const UsbIdentity& identity);

/// Of the strings those that it has: 0, the languages, and 3, the serial. Empty for others.
std::vector<std::uint8_t> usb_string(const UsbIdentity& identity, std::uint8_t index);

/// The next packet for a host that has room for `most` bytes; the status alone if there is nothing to say.
std::vector<std::uint8_t> usb_packet(const UsbFunction& function, std::size_t most);

}  // namespace haptic::test
