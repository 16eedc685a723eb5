#include "drivers/falcon/falcon_firmware.h"

#include <algorithm>
#include <array>
#include <string>

#include "drivers/device_error.h"
#include "drivers/falcon/falcon_protocol.h"

namespace haptic::drivers::falcon {

namespace {

using std::chrono::milliseconds;

constexpr std::array<std::uint8_t, 3> kHello = {0x0A, 0x43, 0x0D};
constexpr std::array<std::uint8_t, 4> kHelloAnswer = {0x0A, 0x44, 0x2C, 0x0D};
constexpr std::uint8_t kLoadMode = 0x41;
// what a packet without force that asks for homing reads as when a boot loader echoes it
constexpr Reply kEcho{.counts = {}, .buttons = 1, .homed = 0};
constexpr std::size_t kChunkBytes = kUsbPacketBytes - kStatusBytes;

// the bridge gives what it has every 16 ms: two periods and some more
constexpr milliseconds kAnswerWait{40};
constexpr milliseconds kEchoWait{500};

/// Reads until `bytes` is full or nothing has come for `wait`; returns how many came.
std::size_t read_all(FtdiPort& port, std::span<std::uint8_t> bytes, milliseconds wait) {
  std::size_t count = 0;
  while (count < bytes.size()) {
    const std::size_t more = port.read(bytes.subspan(count), wait);
    if (more == 0) break;
    count += more;
  }
  return count;
}

void purge(FtdiPort& port) {
  port.control(kPurgeReceived);
  port.control(kPurgeSent);
}

/// Whether the boot loader said what it should; some systems show a zero byte before it.
bool is_hello_answer(std::span<const std::uint8_t> bytes) {
  if (bytes.size() > kHelloAnswer.size() && bytes.front() == 0) bytes = bytes.subspan(1);
  return std::equal(bytes.begin(), bytes.end(), kHelloAnswer.begin(), kHelloAnswer.end());
}

void shake_hands(FtdiPort& port, int tries) {
  bool said_something = false;
  for (int i = 0; i < tries; ++i) {
    port.write(kHello);
    std::array<std::uint8_t, kHelloAnswer.size() + 1> bytes{};
    std::size_t count = read_all(port, std::span(bytes).first<kHelloAnswer.size()>(), kAnswerWait);
    // a zero byte before it leaves one more to be read
    if (count == kHelloAnswer.size() && bytes[0] == 0) {
      count += read_all(port, std::span(bytes).last<1>(), kAnswerWait);
    }
    said_something = said_something || count > 0;
    if (is_hello_answer(std::span(bytes).first(count))) return;
  }
  throw DeviceError(
      said_something ? "the boot loader's answers make no sense; unplug it from USB and power, and try again"
                     : "the boot loader does not answer; is its power supply plugged in?");
}

void send_with_echo(FtdiPort& port, std::span<const std::uint8_t> bytes, std::size_t sent_before) {
  port.write(bytes);
  std::array<std::uint8_t, kChunkBytes> echo{};
  const std::size_t count = read_all(port, std::span(echo).first(bytes.size()), kEchoWait);
  const auto different =
      std::mismatch(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(count), echo.begin()).first;
  const auto good = static_cast<std::size_t>(different - bytes.begin());
  if (good == bytes.size()) return;
  throw DeviceError("uploading firmware: byte " + std::to_string(sent_before + good) +
                    (good < count ? " came back changed" : " did not come back"));
}

}  // namespace

void enter_run_mode(FtdiPort& port) {
  port.control(kLatency1ms);
  port.control(kBaudRun);
  purge(port);
}

bool answers(FtdiPort& port, int probes) {
  ReplyParser parser;
  Reply reply;
  const Packet nothing = encode({});
  for (int probe = 0; probe < probes; ++probe) {
    port.write(nothing);
    std::array<std::uint8_t, kUsbPacketBytes> bytes{};
    // bounded: a device that talks on without sense must not hold the start up
    for (int part = 0; part < 8; ++part) {
      const std::size_t count = port.read(bytes, kAnswerWait);
      if (count == 0) break;
      for (std::size_t i = 0; i < count; ++i) {
        if (parser.take(bytes[i], reply) && reply != kEcho) return true;
      }
    }
  }
  return false;
}

void load_firmware(FtdiPort& port, std::span<const std::uint8_t> firmware, const BootLimits& limits) {
  purge(port);
  port.control(kLatency16ms);
  port.control(kBaudHandshake);
  port.control(kLine8N1);
  port.control(kNoFlowControl);
  port.control(kRtsLow);
  port.control(kDtrLow);
  port.control(kDtrHigh);
  shake_hands(port, limits.handshakes);

  port.control(kDtrLow);
  port.control(kBaudUpload);
  send_with_echo(port, {&kLoadMode, 1}, 0);
  for (std::size_t sent = 0; sent < firmware.size(); sent += kChunkBytes) {
    send_with_echo(port, firmware.subspan(sent, std::min(kChunkBytes, firmware.size() - sent)), sent);
  }
}

void bring_up(FtdiPort& port, std::span<const std::uint8_t> firmware, const BootLimits& limits) {
  purge(port);
  enter_run_mode(port);
  if (answers(port, limits.probes)) return;
  if (firmware.empty()) {
    throw DeviceError("no firmware runs in it, and the config names none (falcon.firmware)");
  }
  std::string last = "no answer after the upload; is this its firmware?";
  for (int attempt = 0; attempt < limits.attempts; ++attempt) {
    try {
      load_firmware(port, firmware, limits);
    } catch (const DeviceError& error) {
      last = error.what();
      continue;
    }
    enter_run_mode(port);
    if (answers(port, limits.probes)) return;
    last = "no answer after the upload; is this its firmware?";
  }
  throw DeviceError("it does not start after " + std::to_string(limits.attempts) + " attempts: " + last);
}

}  // namespace haptic::drivers::falcon
