#include "drivers/io/hid/hid.h"

#include <hidapi/hidapi.h>
#include <unistd.h>

#include <cerrno>
#include <mutex>
#include <set>
#include <vector>

#include "drivers/device_error.h"
#include "drivers/io/same_kind.h"

namespace haptic::drivers::io {

namespace {

/// What does not fit a byte is left out: serials are plain text.
std::string narrow(const wchar_t* text) {
  std::string out;
  for (; text != nullptr && *text != L'\0'; ++text) {
    if (*text > 0 && *text < 0x80) out += static_cast<char>(*text);
  }
  return out;
}

/// What of hidapi is not of one open device: it keeps its last error in a variable of its own, and each
/// device is looked for on its own thread.
std::mutex& library() {
  static std::mutex mutex;
  return mutex;
}

[[noreturn]] void fail(const std::string& what, hid_device* device) {
  const std::string reason = narrow(hid_error(device));
  throw DeviceError(what + (reason.empty() ? " failed" : ": " + reason));
}

}  // namespace

struct HidDevice::Handle {
  explicit Handle(hid_device* opened) : device(opened) {}
  ~Handle() { hid_close(device); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  hid_device* device;
};

HidInfo find_hid(const std::string& what, const std::function<bool(const HidInfo&)>& matches) {
  const std::lock_guard lock(library());
  const std::unique_ptr<hid_device_info, void (*)(hid_device_info*)> list(hid_enumerate(0, 0),
                                                                          &hid_free_enumeration);
  HidInfo found;
  std::vector<std::string> serials;
  std::set<std::string> paths;  // an interface is listed once for each of its usages
  for (const hid_device_info* entry = list.get(); entry != nullptr; entry = entry->next) {
    HidInfo info{.path = entry->path,
                 .vendor = entry->vendor_id,
                 .product = entry->product_id,
                 .interface_number = entry->interface_number,
                 .usage_page = entry->usage_page,
                 .usage = entry->usage,
                 .serial = narrow(entry->serial_number)};
    if (!matches(info)) continue;
    if (!paths.insert(info.path).second) continue;
    serials.push_back(info.serial);
    found = std::move(info);
  }
  if (serials.empty()) throw DeviceAbsent("no " + what + " is connected");
  if (serials.size() > 1) fail_same_kind(what + " devices", std::move(serials));
  return found;
}

HidDevice::HidDevice(const HidInfo& info) {
  const std::lock_guard lock(library());
  hid_device* const device = hid_open_path(info.path.c_str());
  if (device == nullptr && ::access(info.path.c_str(), R_OK | W_OK) != 0 && errno == EACCES) {
    throw DeviceError("no permission to open " + info.path + ": " + kUdevRemedy);
  }
  if (device == nullptr) fail(info.path + " cannot be opened", nullptr);
  handle_ = std::make_unique<Handle>(device);
}

HidDevice::~HidDevice() = default;

std::size_t HidDevice::read(std::span<std::uint8_t> report, std::chrono::milliseconds timeout) {
  const int count =
      hid_read_timeout(handle_->device, report.data(), report.size(), static_cast<int>(timeout.count()));
  if (count < 0) fail("reading a HID report", handle_->device);
  return static_cast<std::size_t>(count);
}

void HidDevice::write(std::span<const std::uint8_t> report) {
  if (hid_write(handle_->device, report.data(), report.size()) < 0) {
    fail("sending a HID report", handle_->device);
  }
}

void HidDevice::send_feature(std::span<const std::uint8_t> report) {
  if (hid_send_feature_report(handle_->device, report.data(), report.size()) < 0) {
    fail("sending a HID feature", handle_->device);
  }
}

std::size_t HidDevice::get_feature(std::span<std::uint8_t> report) {
  const int count = hid_get_feature_report(handle_->device, report.data(), report.size());
  if (count < 0) fail("reading a HID feature", handle_->device);
  return static_cast<std::size_t>(count);
}

}  // namespace haptic::drivers::io
