#include "client/doctor/usb.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <sstream>

namespace haptic::doctor {

namespace {

constexpr const char* kDevices = "/sys/bus/usb/devices/";

std::optional<std::uint16_t> hexadecimal(const std::optional<std::string>& text) {
  if (!text) return std::nullopt;
  unsigned value = 0;
  const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), value, 16);
  if (error != std::errc() || end != text->data() + text->size() || value > 0xffff) return std::nullopt;
  return static_cast<std::uint16_t>(value);
}

std::string last_part(const std::string& path) { return path.substr(path.find_last_of('/') + 1); }

/// The drivers of "1-2:1.0", "1-2:1.1", ...
std::vector<std::string> drivers_of(const Machine& machine, const std::string& port) {
  std::vector<std::string> drivers;
  for (const std::string& name : machine.list(kDevices)) {
    if (!name.starts_with(port + ":")) continue;
    const std::optional<std::string> driver = machine.link(kDevices + name + "/driver");
    if (driver) drivers.push_back(last_part(*driver));
  }
  return drivers;
}

/// "1-2.3" is on the hub "1-2"; empty on a root.
std::string hub_of(const std::string& port) {
  const std::size_t dot = port.find_last_of('.');
  return dot == std::string::npos ? "" : port.substr(0, dot);
}

}  // namespace

std::string id_of(std::uint16_t vendor, std::uint16_t product) {
  return fmt::format("{:04x}:{:04x}", vendor, product);
}

std::vector<UsbDevice> usb_devices(const Machine& machine) {
  std::vector<UsbDevice> devices;
  for (const std::string& port : machine.list(kDevices)) {
    const std::string folder = kDevices + port;
    const auto vendor = hexadecimal(machine.line(folder + "/idVendor"));
    const auto product = hexadecimal(machine.line(folder + "/idProduct"));
    const auto bus = machine.number(folder + "/busnum");
    const auto number = machine.number(folder + "/devnum");
    if (!vendor || !product || !bus || !number) continue;
    devices.push_back({.port = port,
                       .vendor = *vendor,
                       .product = *product,
                       .serial = machine.line(folder + "/serial").value_or(""),
                       .node = fmt::format("/dev/bus/usb/{:03.0f}/{:03.0f}", *bus, *number),
                       .speed = machine.line(folder + "/speed").value_or(""),
                       .drivers = drivers_of(machine, port)});
  }
  return devices;
}

std::vector<HidNode> hid_nodes(const Machine& machine) {
  std::vector<HidNode> nodes;
  for (const std::string& name : machine.list("/sys/class/hidraw")) {
    std::istringstream lines(machine.text("/sys/class/hidraw/" + name + "/device/uevent").value_or(""));
    HidNode node{.node = "/dev/" + name};
    bool is_known = false;
    for (std::string line; std::getline(lines, line);) {
      if (line.starts_with("HID_UNIQ=")) node.serial = line.substr(9);
      // HID_ID=0003:0000046D:0000C626
      if (!line.starts_with("HID_ID=") || line.size() != 29) continue;
      const auto vendor = hexadecimal(line.substr(16, 4));
      const auto product = hexadecimal(line.substr(25, 4));
      is_known = vendor && product;
      if (!is_known) continue;
      node.vendor = *vendor;
      node.product = *product;
    }
    if (is_known) nodes.push_back(node);
  }
  return nodes;
}

void check_usb(const Machine& machine, const std::string& about, const UsbDevice& device,
               Findings& findings) {
  const std::string control = std::string(kDevices) + device.port + "/power/control";
  if (machine.line(control) == "auto") {
    findings.push_back({about, Verdict::kNote, "the kernel may put it to sleep while nobody talks to it",
                        "echo on | sudo tee " + control});
  }
  const std::string hub = hub_of(device.port);
  std::string others;
  for (const UsbDevice& other : usb_devices(machine)) {
    if (hub.empty() || other.port == device.port || hub_of(other.port) != hub) continue;
    others += (others.empty() ? "" : ", ") + id_of(other.vendor, other.product);
  }
  if (others.empty()) return;
  findings.push_back({about, Verdict::kNote,
                      fmt::format("it shares the hub at {} with {}: what they send delays it", hub, others),
                      "lsusb -t"});
}

}  // namespace haptic::doctor
