#include "tests/support/usb_mock.h"

#include <fcntl.h>
#include <linux/usbdevice_fs.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <umockdev.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <deque>
#include <filesystem>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>

namespace haptic::test {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kLatency{1};
constexpr std::uint8_t kFromDevice = 0x80;

// usbfs numbers its requests in 'U'
constexpr unsigned kSetConfiguration = 5;
constexpr unsigned kGetDriver = 8;
constexpr unsigned kSubmit = 10;
constexpr unsigned kDiscard = 11;
constexpr unsigned kReap = 13;
constexpr unsigned kClaim = 15;
constexpr unsigned kRelease = 16;
constexpr unsigned kClearHalt = 21;
constexpr unsigned kGetCapabilities = 26;
constexpr unsigned kDisconnectClaim = 27;

std::string hex(std::span<const std::uint8_t> bytes) {
  std::string text;
  std::array<char, 3> digits{};
  for (const std::uint8_t byte : bytes) {
    (void)std::snprintf(digits.data(), digits.size(), "%02X", byte);
    text += digits.data();
  }
  return text;
}

std::string hex4(unsigned value) {
  std::array<char, 5> digits{};
  (void)std::snprintf(digits.data(), digits.size(), "%04x", value & 0xFFFFU);
  return digits.data();
}

/// One transfer that the host wants: the memory of its process, as umockdev shows it.
struct Urb {
  UMockdevIoctlClient* client;  // whose opening of the node it came through: two may be open at once
  UMockdevIoctlData* block;
  UMockdevIoctlData* buffer;
  Clock::time_point since;

  usbdevfs_urb& urb() const { return *reinterpret_cast<usbdevfs_urb*>(block->data); }
  std::span<std::uint8_t> bytes() const { return {buffer->data, static_cast<std::size_t>(buffer->data_len)}; }
};

}  // namespace

struct UsbMock::Impl {
  Impl(MockBus& on, UsbIdentity who, UsbFunction what)
      : bus(on), identity(std::move(who)), function(std::move(what)) {}

  MockBus& bus;
  UsbIdentity identity;
  UsbFunction function;
  std::string sys_path;
  std::string node;
  UMockdevIoctlBase* handler = nullptr;
  gulong signal = 0;
  int fifo = -1;

  std::mutex mutex;
  std::deque<Urb> waiting;  // for data
  std::deque<Urb> done;
  bool gone = false;
  bool fails_next_out = false;
  bool is_full = true;  // the node: nothing can be reaped
  std::atomic<bool> ending{false};
  std::thread pump;

  void plug_in();
  void make_node();

  // the FIFO stands for the node: one that takes bytes tells the host that there is something to reap
  void fill();
  void drain();
  void tell() {
    if (!done.empty() || gone) drain();
  }

  static gboolean handle(UMockdevIoctlBase* base, UMockdevIoctlClient* client, gpointer self);
  void answer(UMockdevIoctlClient* client);
  void submit(UMockdevIoctlClient* client);
  void reap(UMockdevIoctlClient* client);
  void discard(UMockdevIoctlClient* client);
  void control_request(Urb& urb);
  void finish(Urb urb, int status, std::size_t length);
  bool give_data(Urb& urb, bool even_if_none);
  void serve();
};

void UsbMock::Impl::plug_in() {
  const std::string number = std::to_string(identity.port + 1);
  sys_path = "/devices/pci0000:00/0000:00:14.0/usb1/1-" + std::to_string(identity.port);
  node = "/dev/bus/usb/001/00" + number;
  std::string text =
      "P: " + sys_path + "\nE: DEVNAME=" + node +
      "\nE: DEVTYPE=usb_device\nE: SUBSYSTEM=usb\nE: BUSNUM=001\nE: DEVNUM=00" + number +
      "\nA: busnum=1\\n\nA: devnum=" + number + "\\n\nA: speed=12\\n\nA: bConfigurationValue=1\\n" +
      "\nA: idVendor=" + hex4(identity.vendor) + "\\n\nA: idProduct=" + hex4(identity.product) +
      "\\n\nH: descriptors=" + hex(usb_descriptors(identity)) + "\n";
  // who answers comes first, then the node: a driver may open it as soon as it is told of
  handler = umockdev_ioctl_base_new();
  signal = g_signal_connect(handler, "handle-ioctl", G_CALLBACK(&Impl::handle), this);
  bus.attach(node, handler);
  make_node();
  bus.add(text);
  pump = std::thread([this] { serve(); });
}

void UsbMock::Impl::make_node() {
  const std::string path = bus.real_path(node);
  // only what the preload library does not see reaches the real files; it leaves paths below the root alone
  std::filesystem::create_directories(std::filesystem::path(path).parent_path());
  ::unlink(path.c_str());
  if (::mkfifo(path.c_str(), 0600) != 0) throw std::runtime_error("no FIFO for the device's node");
  fifo = ::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  if (fifo < 0) throw std::runtime_error("the device's node cannot be opened");
  fill();
}

void UsbMock::Impl::fill() {
  constexpr std::array<char, 4096> kNothing{};
  while (::write(fifo, kNothing.data(), kNothing.size()) > 0) {
  }
  is_full = true;
}

void UsbMock::Impl::drain() {
  std::array<char, 4096> block{};
  if (is_full) is_full = ::read(fifo, block.data(), block.size()) <= 0;
}

gboolean UsbMock::Impl::handle(UMockdevIoctlBase* /*base*/, UMockdevIoctlClient* client, gpointer self) {
  Impl& mock = *static_cast<Impl*>(self);
  const std::lock_guard lock(mock.mutex);
  mock.answer(client);
  return TRUE;
}

void UsbMock::Impl::answer(UMockdevIoctlClient* client) {
  switch (_IOC_NR(umockdev_ioctl_client_get_request(client))) {
    case kGetCapabilities: {
      UMockdevIoctlData* const value = umockdev_ioctl_data_resolve(umockdev_ioctl_client_get_arg(client), 0,
                                                                   sizeof(std::uint32_t), nullptr);
      const std::uint32_t capabilities = 0x1f;
      std::memcpy(value->data, &capabilities, sizeof capabilities);
      umockdev_ioctl_client_complete(client, 0, 0);
      g_object_unref(value);
      return;
    }
    case kGetDriver:
      return umockdev_ioctl_client_complete(client, -1, ENODATA);
    case kClaim:
    case kRelease:
    case kDisconnectClaim:
    case kSetConfiguration:
    case kClearHalt:
      return umockdev_ioctl_client_complete(client, gone ? -1 : 0, gone ? ENODEV : 0);
    case kSubmit:
      return submit(client);
    case kReap:
      return reap(client);
    case kDiscard:
      return discard(client);
    default:
      return umockdev_ioctl_client_complete(client, -1, ENOTTY);
  }
}

void UsbMock::Impl::submit(UMockdevIoctlClient* client) {
  if (gone) return umockdev_ioctl_client_complete(client, -1, ENODEV);
  UMockdevIoctlData* const block =
      umockdev_ioctl_data_resolve(umockdev_ioctl_client_get_arg(client), 0, sizeof(usbdevfs_urb), nullptr);
  const auto* const request = reinterpret_cast<const usbdevfs_urb*>(block->data);
  const auto length = static_cast<gsize>(request->buffer_length);
  UMockdevIoctlData* const buffer =
      umockdev_ioctl_data_resolve(block, offsetof(usbdevfs_urb, buffer), std::max<gsize>(length, 1), nullptr);
  Urb urb{.client = client, .block = block, .buffer = buffer, .since = Clock::now()};
  if (request->type == USBDEVFS_URB_TYPE_CONTROL) {
    control_request(urb);
  } else if ((request->endpoint & kFromDevice) != 0) {
    if (!give_data(urb, false)) waiting.push_back(urb);
  } else if (fails_next_out) {
    fails_next_out = false;
    finish(urb, -EPIPE, 0);
  } else {
    function.out(urb.bytes());
    finish(urb, 0, length);
  }
  umockdev_ioctl_client_complete(client, 0, 0);
}

void UsbMock::Impl::control_request(Urb& urb) {
  const std::span<std::uint8_t> bytes = urb.bytes();
  const auto value = static_cast<std::uint16_t>(bytes[2] | bytes[3] << 8U);
  if ((bytes[0] & kFromDevice) == 0) {
    function.control(bytes[1], value);
    return finish(urb, 0, bytes.size() - 8);
  }
  // of what can be read only strings are
  const std::vector<std::uint8_t> text = usb_string(identity, static_cast<std::uint8_t>(value & 0xFFU));
  const std::size_t count = std::min(text.size(), bytes.size() - 8);
  std::copy_n(text.begin(), count, bytes.begin() + 8);
  finish(urb, 0, count);
}

bool UsbMock::Impl::give_data(Urb& urb, bool even_if_none) {
  const std::span<std::uint8_t> bytes = urb.bytes();
  const std::vector<std::uint8_t> packet = usb_packet(function, bytes.size());
  if (packet.size() == kUsbStatusBytes && !even_if_none) return false;
  std::copy(packet.begin(), packet.end(), bytes.begin());
  finish(urb, 0, packet.size());
  return true;
}

void UsbMock::Impl::finish(Urb urb, int status, std::size_t length) {
  urb.urb().status = status;
  urb.urb().actual_length = static_cast<int>(length);
  done.push_back(urb);
  tell();
}

void UsbMock::Impl::reap(UMockdevIoctlClient* client) {
  const auto found =
      std::find_if(done.begin(), done.end(), [&](const Urb& urb) { return urb.client == client; });
  if (found == done.end()) {
    return umockdev_ioctl_client_complete(client, -1, gone ? ENODEV : EAGAIN);
  }
  const Urb urb = *found;
  done.erase(found);
  UMockdevIoctlData* const box =
      umockdev_ioctl_data_resolve(umockdev_ioctl_client_get_arg(client), 0, sizeof(void*), nullptr);
  umockdev_ioctl_data_set_ptr(box, 0, urb.block);
  umockdev_ioctl_client_complete(client, 0, 0);
  g_object_unref(box);
  g_object_unref(urb.buffer);
  g_object_unref(urb.block);
  if (done.empty() && !gone) fill();
}

void UsbMock::Impl::discard(UMockdevIoctlClient* client) {
  gulong address = 0;
  std::memcpy(&address, umockdev_ioctl_client_get_arg(client)->data, sizeof address);
  const auto found = std::find_if(waiting.begin(), waiting.end(), [&](const Urb& urb) {
    return urb.client == client && urb.block->client_addr == address;
  });
  if (found == waiting.end()) return umockdev_ioctl_client_complete(client, -1, EINVAL);
  const Urb urb = *found;
  waiting.erase(found);
  finish(urb, -ENOENT, 0);
  umockdev_ioctl_client_complete(client, 0, 0);
}

void UsbMock::Impl::serve() {
  while (!ending) {
    std::this_thread::sleep_for(std::chrono::microseconds(500));
    const std::lock_guard lock(mutex);
    const auto now = Clock::now();
    while (!waiting.empty() && give_data(waiting.front(), now - waiting.front().since > kLatency)) {
      waiting.pop_front();
    }
  }
}

UsbMock::UsbMock(MockBus& bus, const UsbIdentity& identity, UsbFunction function)
    : impl_(std::make_unique<Impl>(bus, identity, std::move(function))) {
  impl_->plug_in();
}

UsbMock::~UsbMock() {
  impl_->ending = true;
  impl_->pump.join();
  g_signal_handler_disconnect(impl_->handler, impl_->signal);
  umockdev_testbed_detach_ioctl(impl_->bus.testbed(), impl_->node.c_str(), nullptr);
  umockdev_testbed_remove_device(impl_->bus.testbed(), ("/sys" + impl_->sys_path).c_str());
  g_object_unref(impl_->handler);
  for (const std::deque<Urb>* urbs : {&impl_->waiting, &impl_->done}) {
    for (const Urb& urb : *urbs) {
      g_object_unref(urb.buffer);
      g_object_unref(urb.block);
    }
  }
  ::close(impl_->fifo);
}

void UsbMock::unplug() {
  const std::lock_guard lock(impl_->mutex);
  impl_->gone = true;
  while (!impl_->waiting.empty()) {
    impl_->finish(impl_->waiting.front(), -ESHUTDOWN, 0);
    impl_->waiting.pop_front();
  }
  impl_->tell();
}

void UsbMock::fail_next_out() {
  const std::lock_guard lock(impl_->mutex);
  impl_->fails_next_out = true;
}

void UsbMock::with_lock(const std::function<void()>& act) {
  const std::lock_guard lock(impl_->mutex);
  act();
}

}  // namespace haptic::test
