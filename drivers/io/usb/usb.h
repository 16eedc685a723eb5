#pragma once
// USB devices from user space, by libusb: finding and opening one, requests one after the other, and
// transfers that stay in flight. It knows nothing of any device.
//
// One thread uses an open device at a time. Functions throw DeviceError, in words for a person, unless they
// are noexcept. Not real-time safe.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "drivers/device.h"

namespace haptic::drivers::io {

struct UsbMatch {
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  std::string serial{};  // empty: the only one that is connected
};

class UsbDevice {
 public:
  /// Opens the one device that matches and claims its interface 0, from a kernel driver if need be. Throws
  /// DeviceAbsent if there is none, else tells whether there is more than one, or no permission.
  explicit UsbDevice(const UsbMatch& match);
  ~UsbDevice();

  UsbDevice(const UsbDevice&) = delete;
  UsbDevice& operator=(const UsbDevice&) = delete;

  /// Empty if it has none.
  const std::string& serial() const noexcept;

  /// A vendor request without data to the device.
  void control_out(std::uint8_t request, std::uint16_t value, std::uint16_t index);

  /// Sends all bytes.
  void bulk_out(std::uint8_t endpoint, std::span<const std::uint8_t> bytes,
                std::chrono::milliseconds timeout);

  /// One transfer of at most bytes.size(); 0 if `timeout` passes without data.
  std::size_t bulk_in(std::uint8_t endpoint, std::span<std::uint8_t> bytes,
                      std::chrono::milliseconds timeout);

  /// Completes transfers in flight, whose callbacks run here, until `deadline` (CLOCK_MONOTONIC) or until
  /// some were completed.
  void wait(Nanoseconds deadline);

  /// No transfer can succeed any more: it was unplugged, or a transfer failed for good.
  bool is_gone() const noexcept;

 private:
  friend class UsbReader;
  friend class UsbWriter;
  struct Handle;
  std::unique_ptr<Handle> handle_;
};

/// Keeps transfers from the device in flight, so that none of what it says waits for us.
class UsbReader {
 public:
  using Sink = std::function<void(std::span<const std::uint8_t>)>;

  /// `sink` gets the bytes of each completed transfer of at most `bytes`, from within UsbDevice::wait().
  UsbReader(UsbDevice& device, std::uint8_t endpoint, std::size_t bytes, std::size_t count, Sink sink);
  /// Cancels what is in flight and waits for it.
  ~UsbReader();

  UsbReader(const UsbReader&) = delete;
  UsbReader& operator=(const UsbReader&) = delete;

  struct Transfer;  // of libusb's, with its buffer

 private:
  UsbDevice& device_;
  Sink sink_;
  std::vector<std::unique_ptr<Transfer>> transfers_;
};

/// Sends without waiting, from a few buffers of its own.
class UsbWriter {
 public:
  UsbWriter(UsbDevice& device, std::uint8_t endpoint, std::size_t bytes, std::size_t count);
  /// Cancels what is in flight and waits for it.
  ~UsbWriter();

  UsbWriter(const UsbWriter&) = delete;
  UsbWriter& operator=(const UsbWriter&) = delete;

  /// False if all buffers are still in flight, or the device is gone: then nothing is sent. Takes at most as
  /// many bytes as the buffers have.
  bool submit(std::span<const std::uint8_t> bytes) noexcept;

  /// Nothing is in flight.
  bool is_idle() const noexcept;

  struct Transfer;

 private:
  UsbDevice& device_;
  std::vector<std::unique_ptr<Transfer>> transfers_;
};

}  // namespace haptic::drivers::io
