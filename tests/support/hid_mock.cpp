#include "tests/support/hid_mock.h"

#include <fcntl.h>
#include <linux/hidraw.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <mutex>
#include <utility>

namespace haptic::test {

namespace {

constexpr unsigned kSetFeature = 0x06;
constexpr unsigned kGetFeature = 0x07;

std::string hex(unsigned value, int digits) {
  std::array<char, 9> text{};
  (void)std::snprintf(text.data(), text.size(), "%0*X", digits, value);
  return text.data();
}

/// An application collection of the usage, with nothing in it: hidapi looks at no more.
std::string report_descriptor(const HidIdentity& identity) {
  return "05" + hex(identity.usage_page, 2) + "09" + hex(identity.usage, 2) + "A101C0";
}

}  // namespace

struct HidMock::Impl {
  Impl(MockBus& on, HidIdentity who, HidFunction what)
      : bus(on), identity(std::move(who)), function(std::move(what)) {}

  MockBus& bus;
  HidIdentity identity;
  HidFunction function;
  std::string node;
  std::string sys_path;
  std::string hid_path;  // its parent
  UMockdevIoctlBase* handler = nullptr;
  std::array<gulong, 3> signals{};
  int fifo = -1;
  std::mutex mutex;
  bool gone = false;

  void plug_in();
  void answer(UMockdevIoctlClient* client);

  static gboolean on_ioctl(UMockdevIoctlBase* base, UMockdevIoctlClient* client, gpointer self);
  static gboolean on_read(UMockdevIoctlBase* base, UMockdevIoctlClient* client, gpointer self);
  static gboolean on_write(UMockdevIoctlBase* base, UMockdevIoctlClient* client, gpointer self);
};

void HidMock::Impl::plug_in() {
  const std::string id = hex(identity.vendor, 4) + ":" + hex(identity.product, 4);
  const std::string port = std::to_string(identity.port);
  const std::string number = std::to_string(identity.node);
  const std::string usb = "/devices/pci0000:00/0000:00:14.0/usb1/1-" + port;
  const std::string interface = usb + "/1-" + port + ":1." + std::to_string(identity.interface_number);
  const std::string hid_name = "0003:" + id + "." + hex(static_cast<unsigned>(identity.node) + 1, 4);
  hid_path = interface + "/" + hid_name;
  node = "/dev/hidraw" + number;
  sys_path = hid_path + "/hidraw/hidraw" + number;
  // child first
  bus.add("P: " + sys_path + "\nN: hidraw" + number + "\nE: DEVNAME=" + node +
          "\nE: SUBSYSTEM=hidraw\nE: MAJOR=241\nE: MINOR=" + number + "\nA: dev=241:" + number +
          "\\n\nL: device=../../../" + hid_name + "\n");
  // packets, as reports are: what is written at once is read at once
  const std::string path = bus.real_path(node);
  ::unlink(path.c_str());
  if (::mkfifo(path.c_str(), 0600) != 0) throw std::runtime_error("no FIFO for the device's node");
  fifo = ::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  if (fifo < 0 || ::fcntl(fifo, F_SETFL, O_NONBLOCK | O_DIRECT) != 0) {
    throw std::runtime_error("the device's node cannot be opened for packets");
  }
  handler = umockdev_ioctl_base_new();
  signals = {g_signal_connect(handler, "handle-ioctl", G_CALLBACK(&Impl::on_ioctl), this),
             g_signal_connect(handler, "handle-read", G_CALLBACK(&Impl::on_read), this),
             g_signal_connect(handler, "handle-write", G_CALLBACK(&Impl::on_write), this)};
  bus.attach(node, handler);
  // without these hidapi passes it over; a driver may open it as soon as they are there
  bus.add("P: " + hid_path + "\nE: SUBSYSTEM=hid\nE: HID_ID=0003:0000" + hex(identity.vendor, 4) + ":0000" +
          hex(identity.product, 4) + "\nE: HID_NAME=emulated\nE: HID_UNIQ=" + identity.serial +
          "\nH: report_descriptor=" + report_descriptor(identity) + "\n");
  bus.add("P: " + interface + "\nE: DEVTYPE=usb_interface\nE: SUBSYSTEM=usb\nA: bInterfaceNumber=" +
          hex(static_cast<unsigned>(identity.interface_number), 2) + "\\n\n");
  bus.add_once(usb, "P: " + usb +
                        "\nE: DEVTYPE=usb_device\nE: SUBSYSTEM=usb\nA: idVendor=" + hex(identity.vendor, 4) +
                        "\\n\nA: idProduct=" + hex(identity.product, 4) + "\\n\nA: bcdDevice=0100\\n\n");
  // now it can be opened
  umockdev_testbed_uevent(bus.testbed(), ("/sys" + sys_path).c_str(), "add");
}

gboolean HidMock::Impl::on_ioctl(UMockdevIoctlBase* /*base*/, UMockdevIoctlClient* client, gpointer self) {
  Impl& mock = *static_cast<Impl*>(self);
  const std::lock_guard lock(mock.mutex);
  mock.answer(client);
  return TRUE;
}

void HidMock::Impl::answer(UMockdevIoctlClient* client) {
  const gulong request = umockdev_ioctl_client_get_request(client);
  UMockdevIoctlData* const argument = umockdev_ioctl_client_get_arg(client);
  if (gone) return umockdev_ioctl_client_complete(client, -1, ENODEV);
  if (request == HIDIOCGRDESCSIZE) {
    UMockdevIoctlData* const size = umockdev_ioctl_data_resolve(argument, 0, sizeof(int), nullptr);
    const int bytes = static_cast<int>(report_descriptor(identity).size() / 2);
    std::memcpy(size->data, &bytes, sizeof bytes);
    umockdev_ioctl_client_complete(client, 0, 0);
    return g_object_unref(size);
  }
  const unsigned number = _IOC_NR(request);
  if (number != kSetFeature && number != kGetFeature) {
    return umockdev_ioctl_client_complete(client, -1, ENOTTY);
  }
  const gsize length = _IOC_SIZE(request);
  UMockdevIoctlData* const data = umockdev_ioctl_data_resolve(argument, 0, length, nullptr);
  if (number == kSetFeature && function.set_feature) function.set_feature({data->data, length});
  umockdev_ioctl_client_complete(client, static_cast<glong>(length), 0);
  g_object_unref(data);
}

gboolean HidMock::Impl::on_read(UMockdevIoctlBase* /*base*/, UMockdevIoctlClient* client, gpointer self) {
  Impl& mock = *static_cast<Impl*>(self);
  const std::lock_guard lock(mock.mutex);
  if (!mock.gone) return FALSE;  // the FIFO itself is read
  umockdev_ioctl_client_complete(client, -1, ENODEV);
  return TRUE;
}

gboolean HidMock::Impl::on_write(UMockdevIoctlBase* /*base*/, UMockdevIoctlClient* client, gpointer self) {
  Impl& mock = *static_cast<Impl*>(self);
  const std::lock_guard lock(mock.mutex);
  const UMockdevIoctlData* const data = umockdev_ioctl_client_get_arg(client);
  const auto length = static_cast<std::size_t>(data->data_len);
  if (mock.gone) {
    umockdev_ioctl_client_complete(client, -1, ENODEV);
    return TRUE;
  }
  if (mock.function.out) mock.function.out({data->data, length});
  umockdev_ioctl_client_complete(client, static_cast<glong>(length), 0);
  return TRUE;
}

HidMock::HidMock(MockBus& bus, const HidIdentity& identity, HidFunction function)
    : impl_(std::make_unique<Impl>(bus, identity, std::move(function))) {
  impl_->plug_in();
}

HidMock::~HidMock() {
  for (const gulong signal : impl_->signals) g_signal_handler_disconnect(impl_->handler, signal);
  umockdev_testbed_detach_ioctl(impl_->bus.testbed(), impl_->node.c_str(), nullptr);
  umockdev_testbed_remove_device(impl_->bus.testbed(), ("/sys" + impl_->sys_path).c_str());
  umockdev_testbed_remove_device(impl_->bus.testbed(), ("/sys" + impl_->hid_path).c_str());
  g_object_unref(impl_->handler);
  ::close(impl_->fifo);
}

void HidMock::send(std::span<const std::uint8_t> report) {
  if (::write(impl_->fifo, report.data(), report.size()) < 0 && errno != EAGAIN) {
    throw std::runtime_error("a report cannot be sent");
  }
}

void HidMock::unplug() {
  {
    const std::lock_guard lock(impl_->mutex);
    impl_->gone = true;
  }
  const std::uint8_t wake = 0;
  send({&wake, 1});
}

void HidMock::with_lock(const std::function<void()>& act) {
  const std::lock_guard lock(impl_->mutex);
  act();
}

}  // namespace haptic::test
