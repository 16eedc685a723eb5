#include "tests/support/usb_function.h"

#include <algorithm>
#include <array>

namespace haptic::test {

namespace {

constexpr std::array<std::uint8_t, kUsbStatusBytes> kStatus = {0x31, 0x60};
constexpr std::uint8_t kSerial = 3;

}  // namespace

std::vector<std::uint8_t> usb_descriptors(const UsbIdentity& identity) {
  const auto low = [](unsigned value) { return static_cast<std::uint8_t>(value & 0xFFU); };
  const auto high = [](unsigned value) { return static_cast<std::uint8_t>(value >> 8U); };
  const auto serial = identity.serial.empty() ? std::uint8_t{0} : kSerial;
  return {18,
          1,
          0x00,
          0x02,
          0,
          0,
          0,
          64,
          low(identity.vendor),
          high(identity.vendor),
          low(identity.product),
          high(identity.product),
          0x00,
          0x04,
          0,
          0,
          serial,
          1,
          9,
          2,
          32,
          0,
          1,
          1,
          0,
          0x80,
          45,
          9,
          4,
          0,
          0,
          2,
          0xFF,
          0xFF,
          0xFF,
          0,
          7,
          5,
          0x81,
          2,
          64,
          0,
          0,
          7,
          5,
          0x02,
          2,
          64,
          0,
          0};
}

std::vector<std::uint8_t> usb_string(const UsbIdentity& identity, std::uint8_t index) {
  if (index == 0) return {4, 3, 0x09, 0x04};
  if (index != kSerial || identity.serial.empty()) return {};
  std::vector<std::uint8_t> text = {static_cast<std::uint8_t>(2 + 2 * identity.serial.size()), 3};
  for (const char c : identity.serial) text.insert(text.end(), {static_cast<std::uint8_t>(c), 0});
  return text;
}

std::vector<std::uint8_t> usb_packet(const UsbFunction& function, std::size_t most) {
  std::vector<std::uint8_t> packet(kStatus.begin(), kStatus.end());
  const std::vector<std::uint8_t> data = function.in(std::min(most, kUsbPacketBytes) - kUsbStatusBytes);
  packet.insert(packet.end(), data.begin(), data.end());
  return packet;
}

}  // namespace haptic::test
