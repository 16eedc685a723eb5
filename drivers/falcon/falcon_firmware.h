#pragma once
// A Falcon's processor starts with a boot loader and loses its firmware with its power. These are the steps
// from there to a device that answers. The firmware is its maker's, under a licence that forbids to ship it
// with a free program: the user supplies the file.
//
//     run mode, does it answer? --yes--> done
//          | no
//     handshake at 9600 baud --> load mode at 140 000 --> bytes, each echoed --> run mode, does it answer?
//          ^                                                                          | no
//          +------------------------ up to `attempts` times --------------------------+
//
// First attempts after plugging in are known to fail now and then. Not real-time safe. Throws DeviceError.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>

#include "drivers/falcon/ftdi.h"

namespace haptic::drivers::falcon {

/// The bridge, one call after the other. Throws DeviceError if it is gone.
class FtdiPort {
 public:
  virtual ~FtdiPort() = default;
  virtual void control(const FtdiRequest& request) = 0;
  virtual void write(std::span<const std::uint8_t> bytes) = 0;
  /// Data bytes without status, as many as come within `timeout` but at most bytes.size(): returns as soon as
  /// there are some. 0: none came.
  virtual std::size_t read(std::span<std::uint8_t> bytes, std::chrono::milliseconds timeout) = 0;
};

/// No firmware is larger: those known have up to 8492 bytes.
inline constexpr std::size_t kLargestFirmware = 65536;

/// How often things are tried.
struct BootLimits {
  int attempts = 10;
  int handshakes = 25;  // in each attempt, 40 ms each
  int probes = 10;
};

/// Sets the bridge for packets at 1.5 Mbaud.
void enter_run_mode(FtdiPort& port);

/// Whether firmware answers packets, which ask for no force.
bool answers(FtdiPort& port, int probes);

/// One attempt: handshake and upload.
void load_firmware(FtdiPort& port, std::span<const std::uint8_t> firmware, const BootLimits& limits);

/// Afterwards the device answers in run mode. `firmware` may be empty: then it must already run.
void bring_up(FtdiPort& port, std::span<const std::uint8_t> firmware, const BootLimits& limits = {});

}  // namespace haptic::drivers::falcon
