#pragma once
// An emulated USB device that is plugged into the kernel of this machine: the host's side of USB/IP,
// vhci_hcd, gets one end of a socket pair, and this is the other. For the kernel, udev and libusb it is a
// device like any other.
//
// One thread polls descriptor() and calls serve() and advance(). Needs root and the module vhci_hcd. The
// protocol: Documentation/usb/usbip_protocol.rst of the kernel.

#include <array>
#include <chrono>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "tests/support/usb_function.h"

namespace haptic::test {

class UsbipDevice {
 public:
  using Clock = std::chrono::steady_clock;

  UsbipDevice(UsbIdentity identity, UsbFunction function);
  ~UsbipDevice() { unplug(); }
  UsbipDevice(const UsbipDevice&) = delete;
  UsbipDevice& operator=(const UsbipDevice&) = delete;

  /// Into the first port of the virtual hub. Throws std::runtime_error if the kernel does not take it.
  void plug_in();
  /// Without any farewell, as when a cable is pulled.
  void unplug() noexcept;

  /// Readable when the host wants something; -1 while it is not plugged in.
  int descriptor() const noexcept { return socket_; }

  /// Takes one request and answers it, unless it waits for data. Unplugs it if the host has ended.
  void serve();
  /// Answers what waits: with data if there are some, with the status alone after a millisecond.
  void advance(Clock::time_point now);

 private:
  using Header =
      std::array<std::uint32_t, 12>;  // in the host's order, but for the last two words of a request
  struct Waiting {
    std::uint32_t sequence;
    std::size_t most;
    Clock::time_point since;
  };

  bool receive(std::span<std::uint8_t> bytes);
  void submit(const Header& request);
  void unlink(const Header& request);
  void control(const Header& request, std::uint32_t sequence, std::size_t length);
  void answer(std::uint32_t sequence, int status, std::size_t length,
              std::span<const std::uint8_t> data = {});
  void send(Header header, std::span<const std::uint8_t> data);

  UsbIdentity identity_;
  UsbFunction function_;
  int socket_ = -1;
  std::deque<Waiting> waiting_;
};

}  // namespace haptic::test
