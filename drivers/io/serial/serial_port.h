#pragma once
// Serial ports, raw, 8 data bits, no parity, 1 stop bit, by Boost.Asio. It knows nothing of any device.
//
// One thread uses an open port at a time. Functions throw DeviceError, and none waits for ever. Not real-time
// safe.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace haptic::drivers::io {

class SerialPort {
 public:
  /// Opens the port for itself alone. Throws DeviceAbsent if there is none of this path.
  SerialPort(const std::string& path, unsigned baud);
  ~SerialPort();

  SerialPort(const SerialPort&) = delete;
  SerialPort& operator=(const SerialPort&) = delete;

  /// What is there, at most bytes.size(): waits for the first byte only. 0 if `timeout` passes without one.
  std::size_t read_some(std::span<std::uint8_t> bytes, std::chrono::milliseconds timeout);

  /// Sends all bytes.
  void write(std::span<const std::uint8_t> bytes);

  /// Reads and forgets until nothing has come for `quiet`, 2 s at most.
  void drain(std::chrono::milliseconds quiet);

 private:
  struct Port;
  std::unique_ptr<Port> port_;
};

}  // namespace haptic::drivers::io
