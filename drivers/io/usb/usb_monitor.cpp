#include "drivers/io/usb/usb_monitor.h"

#include <libusb-1.0/libusb.h>
#include <sys/time.h>

#include <string>

#include "drivers/device_error.h"

namespace haptic::drivers::io {

namespace {

class UsbMonitor final : public PlugMonitor {
 public:
  UsbMonitor(std::uint16_t vendor, std::uint16_t product) {
    int error = libusb_init(&context_);
    if (error == 0) {
      error = libusb_hotplug_register_callback(context_, LIBUSB_HOTPLUG_EVENT_DEVICE_ARRIVED,
                                               LIBUSB_HOTPLUG_NO_FLAGS, vendor, product,
                                               LIBUSB_HOTPLUG_MATCH_ANY, &UsbMonitor::arrived, this, nullptr);
      if (error != 0) libusb_exit(context_);
    }
    if (error != 0) {
      throw DeviceError(std::string("USB cannot be watched: ") +
                        libusb_strerror(static_cast<libusb_error>(error)));
    }
  }
  ~UsbMonitor() override { libusb_exit(context_); }
  UsbMonitor(const UsbMonitor&) = delete;
  UsbMonitor& operator=(const UsbMonitor&) = delete;

  std::vector<int> descriptors() const override {
    std::vector<int> all;
    const libusb_pollfd** const list = libusb_get_pollfds(context_);
    for (std::size_t i = 0; list != nullptr && list[i] != nullptr; ++i) all.push_back(list[i]->fd);
    libusb_free_pollfds(list);
    return all;
  }

  bool take() override {
    has_arrived_ = false;
    timeval nothing{};
    libusb_handle_events_timeout_completed(context_, &nothing, nullptr);
    return has_arrived_;
  }

 private:
  static int LIBUSB_CALL arrived(libusb_context* /*context*/, libusb_device* /*device*/,
                                 libusb_hotplug_event /*event*/, void* self) {
    static_cast<UsbMonitor*>(self)->has_arrived_ = true;
    return 0;  // and the next one, too
  }

  libusb_context* context_ = nullptr;
  bool has_arrived_ = false;  // set within take() only
};

}  // namespace

std::unique_ptr<PlugMonitor> watch_usb(std::uint16_t vendor, std::uint16_t product) {
  if (libusb_has_capability(LIBUSB_CAP_HAS_HOTPLUG) == 0) return nullptr;
  return std::make_unique<UsbMonitor>(vendor, product);
}

}  // namespace haptic::drivers::io
