#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "client/doctor/checks.h"
#include "client/doctor/nodes.h"
#include "client/doctor/usb.h"

namespace haptic::doctor {

namespace {

constexpr std::uint16_t kFalconVendor = 0x0403;
constexpr std::uint16_t kFalconProduct = 0xcb48;

bool is_falcon(const UsbDevice& device) {
  return device.vendor == kFalconVendor && device.product == kFalconProduct;
}

bool is_spacemouse(const HidNode& node) {
  return node.vendor == 0x256f || (node.vendor == 0x046d && (node.product & 0xff00U) == 0xc600);
}

bool is_hydra(const HidNode& node) { return node.vendor == 0x1532 && node.product == 0x0300; }

/// The ids that a WoodenHaptics arm's firmware has by default.
bool is_polhem(const HidNode& node) {
  return (node.vendor == 0x16c0 && node.product == 0x0486) ||
         (node.vendor == 0x1234 && node.product == 0x0006);
}

/// Empty if it is none that is known.
std::string name_of(const HidNode& node) {
  if (is_spacemouse(node)) return "SpaceMouse";
  if (is_hydra(node)) return "Razer Hydra";
  return is_polhem(node) ? "WoodenHaptics arm" : "";
}

class DeviceCheck {
 public:
  DeviceCheck(const Machine& machine, std::string about, Findings& findings)
      : machine_(machine), about_(std::move(about)), findings_(findings) {}

  void falcon(const v1::Device::Falcon& config) {
    const auto devices = usb_devices(machine_);
    const auto found = std::find_if(devices.begin(), devices.end(), [&](const UsbDevice& device) {
      return is_falcon(device) && (config.serial().empty() || device.serial == config.serial());
    });
    file("firmware", config.firmware());
    if (found == devices.end()) return absent("no Novint Falcon is connected", "lsusb -d 0403:cb48");
    const auto same = std::count_if(devices.begin(), devices.end(), is_falcon);
    if (same > 1 && config.serial().empty()) {
      add(Verdict::kBad,
          fmt::format("{} Falcons are connected, and falcon.serial does not tell which it is", same),
          "lsusb -v -d 0403:cb48 | grep iSerial");
    }
    falcon(*found);
  }

  void falcon(const UsbDevice& device) {
    const bool is_good = check_node(machine_, about_, device.node, findings_);
    for (const std::string& driver : device.drivers) {
      if (driver == "usbfs") continue;  // that is us, or whoever holds the node
      add(Verdict::kNote,
          "the kernel's driver " + driver + " has it; the daemon takes it over while it runs");
    }
    check_usb(machine_, about_, device, findings_);
    if (is_good) good(fmt::format("Novint Falcon at {}, {} Mbit/s", device.node, device.speed));
  }

  /// The first of the HID devices that are meant.
  template <class Matches>
  void hid(const std::string& what, const std::string& serial, const Matches& matches) {
    const auto nodes = hid_nodes(machine_);
    const auto found = std::find_if(nodes.begin(), nodes.end(), [&](const HidNode& node) {
      return matches(node) && (serial.empty() || node.serial == serial);
    });
    if (found == nodes.end()) return absent("no " + what + " is connected", "lsusb; ls /sys/class/hidraw");
    if (check_node(machine_, about_, found->node, findings_)) {
      good(fmt::format("{} ({}) at {}", what, id_of(found->vendor, found->product), found->node));
    }
  }

  void spacemouse(const v1::Device::Spacemouse& config) {
    hid("SpaceMouse", config.serial(), is_spacemouse);
    spacenavd();
  }

  void spacenavd() {
    if (machine_.processes("spacenavd").empty()) return;
    add(Verdict::kWarning, "spacenavd reads it as well, and sets its LED", "sudo systemctl stop spacenavd");
  }

  void polhem(const v1::Device::Polhem& config) {
    if (config.has_udp()) return good("it is served over UDP");
    const unsigned vendor = config.usb().vendor() == 0 ? 0x16c0 : config.usb().vendor();
    const unsigned product = config.usb().product() == 0 ? 0x0486 : config.usb().product();
    hid("WoodenHaptics arm", "",
        [&](const HidNode& node) { return node.vendor == vendor && node.product == product; });
  }

  void serial(const std::string& what, const std::string& port) {
    if (check_serial(machine_, about_, port, findings_)) good(what + " at " + port);
  }

  void phantom(const v1::Device::Phantom& config) {
    file("calibration", config.calibration());
    if (!machine_.exists(config.path())) {
      if (machine_.exists("/sys/module/phantom")) {
        return absent(config.path() + " is not there, though the kernel's module is loaded",
                      "ls /dev/phantom*; lspci -d 10b5:9050");
      }
      return absent(config.path() + " is not there: the kernel's module \"phantom\" is not loaded",
                    "sudo modprobe phantom");
    }
    if (config.calibration().empty())
      add(Verdict::kNote, "without a calibration it gives neither position nor force");
    if (check_node(machine_, about_, config.path(), findings_)) good("PHANToM at " + config.path());
  }

  void external(const v1::Device::External& config) {
    const std::string& path = config.path();
    const std::string folder = std::filesystem::path(path).parent_path().string();
    if (!machine_.exists(folder)) {
      return absent("the folder of its socket, " + folder + ", is not there",
                    "sudo install -d -o " + machine_.user().name + " " + folder);
    }
    if (!machine_.may(Access::kReadAndWrite, folder)) {
      return absent(fmt::format("{} may not make its socket in {} ({})", machine_.user().name, folder,
                                machine_.rights(folder)),
                    "sudo chown " + machine_.user().name + " " + folder);
    }
    good("a program serves it at " + path);
  }

  /// A file that the device reads; nothing if the config names none.
  void file(const std::string& what, const std::string& path) {
    if (path.empty() || machine_.may(Access::kRead, path)) return;
    const bool is_there = machine_.exists(path);
    add(Verdict::kBad,
        fmt::format("its {} {} {}", what, path,
                    is_there ? "may not be read by " + machine_.user().name : "is not there"),
        is_there ? "sudo chmod a+r " + path : "");
  }

  void good(const std::string& reason) { findings_.push_back({about_, Verdict::kOk, reason}); }

 private:
  void absent(const std::string& reason, const std::string& command) { add(Verdict::kBad, reason, command); }
  void add(Verdict verdict, const std::string& reason, const std::string& command = {}) {
    findings_.push_back({about_, verdict, reason, command});
  }
  const Machine& machine_;
  std::string about_;
  Findings& findings_;
};

}  // namespace

void check_device(const Machine& machine, const v1::Device& device, Findings& findings) {
  DeviceCheck check(machine, "device " + device.name(), findings);
  const std::size_t before = findings.size();
  switch (device.driver_case()) {
    case v1::Device::kFalcon:
      return check.falcon(device.falcon());
    case v1::Device::kSpacemouse:
      return check.spacemouse(device.spacemouse());
    case v1::Device::kHydra:
      return check.hid("Razer Hydra", "", is_hydra);
    case v1::Device::kPolhem:
      return check.polhem(device.polhem());
    case v1::Device::kFastrak:
      return check.serial("FASTRAK", device.fastrak().port());
    case v1::Device::kHaply:
      return check.serial("Haply 2DIY", device.haply().port());
    case v1::Device::kPhantom:
      return check.phantom(device.phantom());
    case v1::Device::kExternal:
      return check.external(device.external());
    case v1::Device::kSimulated:
      check.file("path", device.simulated().hand().path());
      break;
    case v1::Device::kPlayback:
      check.file("path", device.playback().path());
      break;
    default:
      break;
  }
  if (findings.size() == before) check.good("it needs nothing of the machine");
}

void check_connected(const Machine& machine, Findings& findings) {
  const std::size_t before = findings.size();
  for (const UsbDevice& device : usb_devices(machine)) {
    if (is_falcon(device)) DeviceCheck(machine, "usb " + device.port, findings).falcon(device);
  }
  for (const HidNode& node : hid_nodes(machine)) {
    const std::string what = name_of(node);
    if (what.empty()) continue;
    DeviceCheck check(machine, node.node.substr(5), findings);
    check.hid(what, node.serial, [&](const HidNode& other) { return other.node == node.node; });
    if (is_spacemouse(node)) check.spacenavd();
  }
  for (const std::string& name : machine.list("/dev")) {
    if (!name.starts_with("phantom") || name.find_first_not_of("0123456789", 7) != std::string::npos)
      continue;
    if (check_node(machine, name, "/dev/" + name, findings))
      findings.push_back({name, Verdict::kOk, "PHANToM at /dev/" + name});
  }
  for (const std::string& name : machine.list("/sys/bus/usb-serial/devices")) {
    if (check_serial(machine, name, "/dev/" + name, findings))
      findings.push_back({name, Verdict::kOk, "serial port /dev/" + name});
  }
  if (findings.size() != before) return;
  findings.push_back(
      {"devices", Verdict::kNote, "none is connected that is found without a config; --config names others"});
}

}  // namespace haptic::doctor
