#include "drivers/io/usb/usb.h"

#include <libusb-1.0/libusb.h>
#include <poll.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <string_view>
#include <utility>

#include "drivers/device_error.h"
#include "drivers/io/same_kind.h"
#include "rt/tick_clock.h"

namespace haptic::drivers::io {

namespace {

constexpr unsigned kControlTimeoutMs = 1000;
constexpr int kInterface = 0;

// a device that does not give a cancelled transfer back within a second never will
constexpr Nanoseconds kCancelWait = 1'000'000'000;

std::string hex_id(const UsbMatch& match) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (const unsigned id : {unsigned{match.vendor}, unsigned{match.product}}) {
    if (!text.empty()) text += ':';
    for (const unsigned shift : {12U, 8U, 4U, 0U}) text += kDigits[(id >> shift) & 15U];
  }
  return text;
}

[[noreturn]] void fail(const std::string& what, int error) {
  throw DeviceError(what + ": " + libusb_strerror(static_cast<libusb_error>(error)));
}

std::string serial_of(libusb_device_handle* handle, const libusb_device_descriptor& descriptor) {
  std::array<unsigned char, 256> text{};
  if (descriptor.iSerialNumber == 0) return {};
  const int length = libusb_get_string_descriptor_ascii(handle, descriptor.iSerialNumber, text.data(),
                                                        static_cast<int>(text.size()));
  return length > 0
             ? std::string(reinterpret_cast<const char*>(text.data()), static_cast<std::size_t>(length))
             : std::string();
}

/// A transfer that never came back still belongs to libusb: its memory is left to it.
template <class Transfers>
void keep_what_is_in_flight(Transfers& transfers) noexcept {
  for (auto& transfer : transfers) {
    if (transfer->in_flight) (void)transfer.release();
  }
}

/// Whether a transfer with this status may be submitted again.
bool goes_on(libusb_transfer_status status) {
  return status == LIBUSB_TRANSFER_COMPLETED || status == LIBUSB_TRANSFER_TIMED_OUT;
}

}  // namespace

struct UsbDevice::Handle {
  libusb_context* context = nullptr;
  libusb_device_handle* device = nullptr;
  std::string serial;
  bool claimed = false;
  bool gone = false;
  std::vector<pollfd> descriptors;

  Handle() = default;
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() {
    if (claimed) libusb_release_interface(device, kInterface);
    if (device != nullptr) libusb_close(device);
    if (context != nullptr) libusb_exit(context);
  }

  void open(const UsbMatch& match);
  void find_descriptors();

  /// Completes what has been given back, without waiting.
  void handle_events() noexcept {
    timeval nothing{};
    libusb_handle_events_timeout_completed(context, &nothing, nullptr);
  }

  /// Completes transfers until `is_done` or nobody can expect that any more.
  template <class Done>
  void drain(const Done& is_done) noexcept {
    const Nanoseconds give_up = rt::monotonic_ns() + kCancelWait;
    while (!is_done() && rt::monotonic_ns() < give_up) {
      timeval some{.tv_sec = 0, .tv_usec = 10'000};
      libusb_handle_events_timeout_completed(context, &some, nullptr);
    }
  }
};

void UsbDevice::Handle::open(const UsbMatch& match) {
  if (const int error = libusb_init(&context); error != 0) {
    context = nullptr;
    fail("USB cannot be used", error);
  }
  libusb_device** list = nullptr;
  const ssize_t count = libusb_get_device_list(context, &list);
  if (count < 0) fail("USB devices cannot be listed", static_cast<int>(count));
  const std::unique_ptr<libusb_device*, void (*)(libusb_device**)> owned(
      list, [](libusb_device** devices) { libusb_free_device_list(devices, 1); });

  std::vector<std::string> serials;  // of those that match
  int refused = 0;
  for (ssize_t i = 0; i < count; ++i) {
    libusb_device_descriptor descriptor{};
    if (libusb_get_device_descriptor(list[i], &descriptor) != 0) continue;
    if (descriptor.idVendor != match.vendor || descriptor.idProduct != match.product) continue;
    libusb_device_handle* candidate = nullptr;
    if (const int error = libusb_open(list[i], &candidate); error != 0) {
      refused = error;
      continue;
    }
    std::string own = serial_of(candidate, descriptor);
    if (!match.serial.empty() && own != match.serial) {
      libusb_close(candidate);
      continue;
    }
    serials.push_back(own);
    if (device != nullptr) libusb_close(device);
    device = candidate;
    serial = std::move(own);
  }
  const std::string id = hex_id(match);
  const std::string wanted = match.serial.empty() ? id : id + " with serial " + match.serial;
  if (serials.size() > 1) fail_same_kind("USB devices " + wanted, std::move(serials));
  if (serials.empty() && refused == LIBUSB_ERROR_ACCESS) {
    throw DeviceError("no permission to open the USB device " + id + ": " + kUdevRemedy);
  }
  if (serials.empty() && refused != 0) fail("the USB device " + id + " cannot be opened", refused);
  if (serials.empty()) throw DeviceAbsent("no USB device " + wanted + " is connected");

  // not supported everywhere, and then there is no kernel driver to detach
  (void)libusb_set_auto_detach_kernel_driver(device, 1);
  if (const int error = libusb_claim_interface(device, kInterface); error != 0) {
    fail("the USB device " + id + " is in use", error);
  }
  claimed = true;
}

// libusb waits in whole milliseconds, which is too coarse for 1 kHz: we wait on its descriptors ourselves
void UsbDevice::Handle::find_descriptors() {
  const libusb_pollfd** list = libusb_get_pollfds(context);
  if (list == nullptr) throw DeviceError("USB has no descriptors to wait on");
  for (std::size_t i = 0; list[i] != nullptr; ++i) {
    descriptors.push_back({.fd = list[i]->fd, .events = list[i]->events, .revents = 0});
  }
  libusb_free_pollfds(list);
}

UsbDevice::UsbDevice(const UsbMatch& match) : handle_(std::make_unique<Handle>()) {
  handle_->open(match);
  handle_->find_descriptors();
}

UsbDevice::~UsbDevice() = default;

const std::string& UsbDevice::serial() const noexcept { return handle_->serial; }

bool UsbDevice::is_gone() const noexcept { return handle_->gone; }

void UsbDevice::control_out(std::uint8_t request, std::uint16_t value, std::uint16_t index) {
  constexpr auto kVendorOut = static_cast<std::uint8_t>(LIBUSB_REQUEST_TYPE_VENDOR);  // to the device
  const int error = libusb_control_transfer(handle_->device, kVendorOut, request, value, index, nullptr, 0,
                                            kControlTimeoutMs);
  if (error == LIBUSB_ERROR_NO_DEVICE) handle_->gone = true;
  if (error < 0) fail("USB request " + std::to_string(request), error);
}

void UsbDevice::bulk_out(std::uint8_t endpoint, std::span<const std::uint8_t> bytes,
                         std::chrono::milliseconds timeout) {
  while (!bytes.empty()) {
    int sent = 0;
    // libusb only reads what is sent
    const int error =
        libusb_bulk_transfer(handle_->device, endpoint, const_cast<std::uint8_t*>(bytes.data()),
                             static_cast<int>(bytes.size()), &sent, static_cast<unsigned>(timeout.count()));
    if (error == LIBUSB_ERROR_NO_DEVICE) handle_->gone = true;
    if (error != 0) fail("sending over USB", error);
    bytes = bytes.subspan(static_cast<std::size_t>(sent));
  }
}

std::size_t UsbDevice::bulk_in(std::uint8_t endpoint, std::span<std::uint8_t> bytes,
                               std::chrono::milliseconds timeout) {
  int received = 0;
  const int error =
      libusb_bulk_transfer(handle_->device, endpoint, bytes.data(), static_cast<int>(bytes.size()), &received,
                           static_cast<unsigned>(timeout.count()));
  if (error == LIBUSB_ERROR_NO_DEVICE) handle_->gone = true;
  if (error != 0 && error != LIBUSB_ERROR_TIMEOUT) fail("receiving over USB", error);
  return static_cast<std::size_t>(received);
}

void UsbDevice::wait(Nanoseconds deadline) {
  const Nanoseconds left = std::max<Nanoseconds>(0, deadline - rt::monotonic_ns());
  const timespec timeout{.tv_sec = static_cast<std::time_t>(left / 1'000'000'000),
                         .tv_nsec = static_cast<long>(left % 1'000'000'000)};
  (void)::ppoll(handle_->descriptors.data(), handle_->descriptors.size(), &timeout, nullptr);
  handle_->handle_events();
}

// ---- reading ----

struct UsbReader::Transfer {
  Transfer(UsbReader& reader, std::uint8_t endpoint, std::size_t bytes)
      : owner(reader), buffer(bytes), transfer(libusb_alloc_transfer(0)) {
    if (transfer == nullptr) throw DeviceError("no memory for a USB transfer");
    libusb_fill_bulk_transfer(transfer, reader.device_.handle_->device, endpoint, buffer.data(),
                              static_cast<int>(bytes), &Transfer::complete, this, 0);
  }
  ~Transfer() { libusb_free_transfer(transfer); }
  Transfer(const Transfer&) = delete;
  Transfer& operator=(const Transfer&) = delete;

  void submit() noexcept {
    in_flight = libusb_submit_transfer(transfer) == 0;
    if (!in_flight) owner.device_.handle_->gone = true;
  }

  static void LIBUSB_CALL complete(libusb_transfer* transfer) {
    Transfer& self = *static_cast<Transfer*>(transfer->user_data);
    self.in_flight = false;
    if (self.cancelled) return;
    if (!goes_on(transfer->status)) {
      self.owner.device_.handle_->gone = true;
      return;
    }
    self.owner.sink_({self.buffer.data(), static_cast<std::size_t>(transfer->actual_length)});
    self.submit();
  }

  UsbReader& owner;
  std::vector<std::uint8_t> buffer;
  libusb_transfer* transfer;
  bool in_flight = false;
  bool cancelled = false;
};

UsbReader::UsbReader(UsbDevice& device, std::uint8_t endpoint, std::size_t bytes, std::size_t count,
                     Sink sink)
    : device_(device), sink_(std::move(sink)) {
  transfers_.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    transfers_.push_back(std::make_unique<Transfer>(*this, endpoint, bytes));
  }
  for (const auto& transfer : transfers_) transfer->submit();
}

UsbReader::~UsbReader() {
  for (const auto& transfer : transfers_) {
    transfer->cancelled = true;
    if (transfer->in_flight) (void)libusb_cancel_transfer(transfer->transfer);
  }
  device_.handle_->drain([&] {
    return std::none_of(transfers_.begin(), transfers_.end(), [](const auto& t) { return t->in_flight; });
  });
  keep_what_is_in_flight(transfers_);
}

// ---- writing ----

struct UsbWriter::Transfer {
  Transfer(UsbDevice& device, std::uint8_t endpoint, std::size_t bytes)
      : handle(*device.handle_), buffer(bytes), transfer(libusb_alloc_transfer(0)) {
    if (transfer == nullptr) throw DeviceError("no memory for a USB transfer");
    libusb_fill_bulk_transfer(transfer, handle.device, endpoint, buffer.data(), 0, &Transfer::complete, this,
                              0);
  }
  ~Transfer() { libusb_free_transfer(transfer); }
  Transfer(const Transfer&) = delete;
  Transfer& operator=(const Transfer&) = delete;

  static void LIBUSB_CALL complete(libusb_transfer* transfer) {
    Transfer& self = *static_cast<Transfer*>(transfer->user_data);
    self.in_flight = false;
    if (!self.cancelled && !goes_on(transfer->status)) self.handle.gone = true;
  }

  UsbDevice::Handle& handle;
  std::vector<std::uint8_t> buffer;
  libusb_transfer* transfer;
  bool in_flight = false;
  bool cancelled = false;
};

UsbWriter::UsbWriter(UsbDevice& device, std::uint8_t endpoint, std::size_t bytes, std::size_t count)
    : device_(device) {
  transfers_.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    transfers_.push_back(std::make_unique<Transfer>(device, endpoint, bytes));
  }
}

UsbWriter::~UsbWriter() {
  for (const auto& transfer : transfers_) {
    transfer->cancelled = true;
    if (transfer->in_flight) (void)libusb_cancel_transfer(transfer->transfer);
  }
  device_.handle_->drain([&] { return is_idle(); });
  keep_what_is_in_flight(transfers_);
}

bool UsbWriter::is_idle() const noexcept {
  return std::none_of(transfers_.begin(), transfers_.end(), [](const auto& t) { return t->in_flight; });
}

bool UsbWriter::submit(std::span<const std::uint8_t> bytes) noexcept {
  const auto free =
      std::find_if(transfers_.begin(), transfers_.end(), [](const auto& t) { return !t->in_flight; });
  if (free == transfers_.end() || device_.handle_->gone) return false;
  Transfer& next = **free;
  const std::size_t count = std::min(bytes.size(), next.buffer.size());
  std::copy_n(bytes.begin(), count, next.buffer.begin());
  next.transfer->length = static_cast<int>(count);
  next.in_flight = libusb_submit_transfer(next.transfer) == 0;
  if (!next.in_flight) device_.handle_->gone = true;
  return next.in_flight;
}

}  // namespace haptic::drivers::io
