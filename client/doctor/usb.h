#pragma once
// USB and HID devices as the kernel tells them in /sys.

#include <cstdint>
#include <string>
#include <vector>

#include "client/doctor/finding.h"
#include "client/doctor/machine.h"

namespace haptic::doctor {

struct UsbDevice {
  std::string port;  // "1-2.3": bus, then the ports from the root on
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  std::string serial{};
  std::string node;                  // /dev/bus/usb/001/005
  std::string speed;                 // Mbit/s, as the kernel writes it
  std::vector<std::string> drivers;  // of the kernel, that have its interfaces
};

std::vector<UsbDevice> usb_devices(const Machine& machine);

struct HidNode {
  std::string node;  // /dev/hidraw0
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  std::string serial{};
};

std::vector<HidNode> hid_nodes(const Machine& machine);

/// "0403:cb48"
std::string id_of(std::uint16_t vendor, std::uint16_t product);

/// What delays a device: that it may be put to sleep, and who is on the same hub below a root.
void check_usb(const Machine& machine, const std::string& about, const UsbDevice& device, Findings& findings);

}  // namespace haptic::doctor
