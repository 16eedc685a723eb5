#include "drivers/io/udev/udev_monitor.h"

#include <libudev.h>

#include <string_view>

#include "drivers/device_error.h"

namespace haptic::drivers::io {

namespace {

template <auto unref>
struct Unref {
  template <class T>
  void operator()(T* object) const noexcept {
    unref(object);
  }
};

class UdevMonitor final : public PlugMonitor {
 public:
  explicit UdevMonitor(const std::string& subsystem)
      : udev_(udev_new()), monitor_(udev_ ? udev_monitor_new_from_netlink(udev_.get(), "udev") : nullptr) {
    const bool watches =
        monitor_ &&
        udev_monitor_filter_add_match_subsystem_devtype(monitor_.get(), subsystem.c_str(), nullptr) >= 0 &&
        udev_monitor_enable_receiving(monitor_.get()) >= 0;
    if (!watches) throw DeviceError("udev cannot be watched for " + subsystem);
  }

  std::vector<int> descriptors() const override { return {udev_monitor_get_fd(monitor_.get())}; }

  bool take() override {
    bool has_come = false;
    // its socket does not block
    while (const std::unique_ptr<udev_device, Unref<udev_device_unref>> device{
        udev_monitor_receive_device(monitor_.get())}) {
      const char* const action = udev_device_get_action(device.get());
      has_come = has_come || (action != nullptr && std::string_view(action) == "add");
    }
    return has_come;
  }

 private:
  std::unique_ptr<udev, Unref<udev_unref>> udev_;
  std::unique_ptr<udev_monitor, Unref<udev_monitor_unref>> monitor_;
};

}  // namespace

std::unique_ptr<PlugMonitor> watch_udev(const std::string& subsystem) {
  return std::make_unique<UdevMonitor>(subsystem);
}

}  // namespace haptic::drivers::io
