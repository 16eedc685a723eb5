#include "tests/system/usbip_device.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

namespace haptic::test {

namespace {

using namespace std::chrono_literals;

constexpr const char* kAttach = "/sys/devices/platform/vhci_hcd.0/attach";
constexpr auto kPortIsFreed = 10s;  // after a device was pulled out of it
constexpr unsigned kPort = 0;
constexpr unsigned kDeviceId = 0x10002;
constexpr unsigned kFullSpeed = 2;  // of the kernel's usb_device_speed

constexpr std::uint32_t kCmdSubmit = 1;
constexpr std::uint32_t kCmdUnlink = 2;
constexpr std::uint32_t kRetSubmit = 3;
constexpr std::uint32_t kRetUnlink = 4;
// where a header has what
constexpr std::size_t kCommand = 0;
constexpr std::size_t kSequence = 1;
constexpr std::size_t kDirection = 3;
constexpr std::size_t kEndpoint = 4;
constexpr std::size_t kUnlinked = 5;
constexpr std::size_t kStatus = 5;
constexpr std::size_t kLength = 6;
constexpr std::size_t kReturned = 6;
constexpr std::size_t kSetup = 10;

// of chapter 9 of the USB specification
constexpr std::uint8_t kVendorRequest = 0x40;
constexpr std::uint8_t kFromDevice = 0x80;
constexpr std::uint8_t kGetStatus = 0;
constexpr std::uint8_t kGetDescriptor = 6;
constexpr std::uint8_t kDeviceType = 1;
constexpr std::uint8_t kConfigurationType = 2;
constexpr std::uint8_t kStringType = 3;

constexpr auto kLatency = 1ms;

/// What it answers to a standard request for data; nothing if it stalls.
std::optional<std::vector<std::uint8_t>> standard_data(const UsbIdentity& identity,
                                                       std::span<const std::uint8_t> setup) {
  if (setup[1] == kGetStatus) return std::vector<std::uint8_t>{0, 0};
  if (setup[1] != kGetDescriptor) return std::nullopt;
  const std::vector<std::uint8_t> all = usb_descriptors(identity);
  const auto middle = all.begin() + kUsbDeviceDescriptorBytes;
  if (setup[3] == kDeviceType) return std::vector<std::uint8_t>(all.begin(), middle);
  if (setup[3] == kConfigurationType) return std::vector<std::uint8_t>(middle, all.end());
  std::vector<std::uint8_t> text;
  if (setup[3] == kStringType) text = usb_string(identity, setup[2]);
  if (text.empty()) return std::nullopt;
  return text;
}

}  // namespace

UsbipDevice::UsbipDevice(UsbIdentity identity, UsbFunction function)
    : identity_(std::move(identity)), function_(std::move(function)) {}

void UsbipDevice::plug_in() {
  if (socket_ >= 0) return;
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    throw std::system_error(errno, std::generic_category(), "socketpair");
  }
  const std::string line = std::to_string(kPort) + " " + std::to_string(ends[1]) + " " +
                           std::to_string(kDeviceId) + " " + std::to_string(kFullSpeed);
  const int attach = ::open(kAttach, O_WRONLY | O_CLOEXEC);
  int error = attach < 0 ? errno : 0;
  const auto give_up = Clock::now() + kPortIsFreed;
  while (attach >= 0) {
    error = ::write(attach, line.data(), line.size()) < 0 ? errno : 0;
    if (error != EBUSY || Clock::now() > give_up) break;
    std::this_thread::sleep_for(10ms);
  }
  if (attach >= 0) ::close(attach);
  ::close(ends[1]);  // the kernel has its own hold of it
  if (error != 0) {
    ::close(ends[0]);
    throw std::system_error(error, std::generic_category(), kAttach);
  }
  socket_ = ends[0];
}

void UsbipDevice::unplug() noexcept {
  if (socket_ >= 0) ::close(socket_);
  socket_ = -1;
  waiting_.clear();
}

bool UsbipDevice::receive(std::span<std::uint8_t> bytes) {
  if (bytes.empty()) return true;
  if (::recv(socket_, bytes.data(), bytes.size(), MSG_WAITALL) == static_cast<ssize_t>(bytes.size()))
    return true;
  unplug();
  return false;
}

void UsbipDevice::serve() {
  std::array<std::uint8_t, sizeof(Header)> bytes{};
  if (!receive(bytes)) return;
  auto request = std::bit_cast<Header>(bytes);
  for (std::size_t i = 0; i < kSetup; ++i) request[i] = ntohl(request[i]);
  if (request[kCommand] == kCmdSubmit) return submit(request);
  if (request[kCommand] == kCmdUnlink) return unlink(request);
  throw std::runtime_error("USB/IP has no command " + std::to_string(request[kCommand]));
}

void UsbipDevice::submit(const Header& request) {
  const std::uint32_t sequence = request[kSequence];
  const std::size_t length = request[kLength];
  if (request[kEndpoint] == 0) return control(request, sequence, length);
  if (request[kDirection] != 0) {
    waiting_.push_back({.sequence = sequence, .most = length, .since = Clock::now()});
    return;
  }
  std::vector<std::uint8_t> data(length);
  if (!receive(data)) return;
  function_.out(data);
  answer(sequence, 0, length);
}

void UsbipDevice::control(const Header& request, std::uint32_t sequence, std::size_t length) {
  const auto setup =
      std::bit_cast<std::array<std::uint8_t, 8>>(std::array{request[kSetup], request[kSetup + 1]});
  if ((setup[0] & kFromDevice) == 0) {
    std::vector<std::uint8_t> data(length);
    if (!receive(data)) return;
    if (setup[0] == kVendorRequest) {
      function_.control(setup[1], static_cast<std::uint16_t>(setup[2] | setup[3] << 8U));
    }
    return answer(sequence, 0, length);
  }
  const auto data = standard_data(identity_, setup);
  if (!data) return answer(sequence, -EPIPE, 0);
  const std::size_t count = std::min(length, data->size());
  answer(sequence, 0, count, std::span(*data).first(count));
}

void UsbipDevice::unlink(const Header& request) {
  const auto found = std::find_if(waiting_.begin(), waiting_.end(), [&](const Waiting& transfer) {
    return transfer.sequence == request[kUnlinked];
  });
  const bool is_in_time = found != waiting_.end();
  if (is_in_time) waiting_.erase(found);
  Header header{kRetUnlink, request[kSequence]};
  header[kStatus] = static_cast<std::uint32_t>(is_in_time ? -ECONNRESET : 0);
  send(header, {});
}

void UsbipDevice::advance(Clock::time_point now) {
  while (socket_ >= 0 && !waiting_.empty()) {
    const Waiting& transfer = waiting_.front();
    const std::vector<std::uint8_t> packet = usb_packet(function_, transfer.most);
    if (packet.size() == kUsbStatusBytes && now - transfer.since < kLatency) return;
    const std::uint32_t sequence = transfer.sequence;
    waiting_.pop_front();
    answer(sequence, 0, packet.size(), packet);
  }
}

void UsbipDevice::answer(std::uint32_t sequence, int status, std::size_t length,
                         std::span<const std::uint8_t> data) {
  Header header{kRetSubmit, sequence};
  header[kStatus] = static_cast<std::uint32_t>(status);
  header[kReturned] = static_cast<std::uint32_t>(length);
  send(header, data);
}

void UsbipDevice::send(Header header, std::span<const std::uint8_t> data) {
  for (std::uint32_t& word : header) word = htonl(word);
  std::vector<std::uint8_t> bytes(sizeof header);
  std::memcpy(bytes.data(), header.data(), sizeof header);
  bytes.insert(bytes.end(), data.begin(), data.end());
  if (::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL) != static_cast<ssize_t>(bytes.size()))
    unplug();
}

}  // namespace haptic::test
