#include "drivers/falcon/falcon_firmware.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "drivers/device_error.h"
#include "tests/support/falcon_emulator.h"

namespace haptic::drivers::falcon {
namespace {

/// The bridge with the emulated device behind it, at most `chunk` bytes in each read.
class MemoryPort final : public FtdiPort {
 public:
  explicit MemoryPort(test::FalconEmulator& device,
                      std::size_t chunk = std::numeric_limits<std::size_t>::max())
      : device_(device), chunk_(chunk) {}

  void control(const FtdiRequest& request) override {
    if (unplugged) throw DeviceError("unplugged");
    device_.control(request.request, request.value);
  }
  void write(std::span<const std::uint8_t> bytes) override {
    if (unplugged || writes_left == 0) throw DeviceError("unplugged");
    --writes_left;
    largest_write = std::max(largest_write, bytes.size());
    device_.receive(bytes);
  }
  std::size_t read(std::span<std::uint8_t> bytes, std::chrono::milliseconds /*timeout*/) override {
    const std::vector<std::uint8_t> data = device_.send(std::min(bytes.size(), chunk_));
    std::copy(data.begin(), data.end(), bytes.begin());
    return data.size();
  }

  bool unplugged = false;
  std::size_t writes_left = std::numeric_limits<std::size_t>::max();
  std::size_t largest_write = 0;

 private:
  test::FalconEmulator& device_;
  std::size_t chunk_;
};

/// 1000 bytes in which every value occurs.
std::vector<std::uint8_t> firmware() {
  std::vector<std::uint8_t> bytes(1000);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(i * 7);
  return bytes;
}

std::string error_of(FtdiPort& port, std::span<const std::uint8_t> blob, const BootLimits& limits = {}) {
  try {
    bring_up(port, blob, limits);
  } catch (const DeviceError& error) {
    return error.what();
  }
  return "";
}

using Stage = test::FalconEmulator::Stage;

TEST(FalconFirmware, ADeviceThatRunsNeedsNone) {
  test::FalconEmulator device;
  MemoryPort port(device);
  bring_up(port, {});
  EXPECT_GE(device.packets(), 1U);
  EXPECT_EQ(device.motors(), (std::array<int, 3>{})) << "asking whether it runs asks for no force";
}

TEST(FalconFirmware, IsUploadedInChunksThatABridgeTakesWhole) {
  test::FalconEmulator device(firmware());
  MemoryPort port(device);
  bring_up(port, firmware());
  EXPECT_EQ(device.stage(), Stage::kRunning);
  EXPECT_EQ(port.largest_write, 62U);
}

TEST(FalconFirmware, EchoesMayComeByteByByte) {
  test::FalconEmulator device(firmware());
  MemoryPort port(device, 1);
  bring_up(port, firmware());
  EXPECT_EQ(device.stage(), Stage::kRunning);
}

TEST(FalconFirmware, AZeroBeforeTheHandshakesAnswerIsAccepted) {
  test::FalconEmulator device(firmware());
  device.troubles.leading_zero = true;
  MemoryPort port(device);
  bring_up(port, firmware());
  EXPECT_EQ(device.stage(), Stage::kRunning);
}

TEST(FalconFirmware, TheFirstHandshakesMayBeIgnored) {
  test::FalconEmulator device(firmware());
  device.troubles.deaf_hellos = 24;
  MemoryPort port(device);
  bring_up(port, firmware(), {.attempts = 1});
  EXPECT_EQ(device.stage(), Stage::kRunning);
}

TEST(FalconFirmware, AChangedEchoCostsOneAttempt) {
  test::FalconEmulator device(firmware());
  device.troubles.changed_echoes = 2;
  MemoryPort port(device);
  bring_up(port, firmware(), {.attempts = 3});
  EXPECT_EQ(device.stage(), Stage::kRunning);

  test::FalconEmulator worse(firmware());
  worse.troubles.changed_echoes = 3;
  MemoryPort worse_port(worse);
  const std::string error = error_of(worse_port, firmware(), {.attempts = 3});
  EXPECT_NE(error.find("3 attempts"), std::string::npos) << error;
  EXPECT_NE(error.find("byte 499 came back changed"), std::string::npos) << error;
}

TEST(FalconFirmware, WithoutAFileADeviceThatDoesNotRunIsAnErrorThatNamesTheField) {
  test::FalconEmulator device(firmware());
  MemoryPort port(device);
  const std::string error = error_of(port, {});
  EXPECT_NE(error.find("falcon.firmware"), std::string::npos) << error;
}

TEST(FalconFirmware, TheWrongFileIsTold) {
  test::FalconEmulator device(firmware());
  MemoryPort port(device);
  const std::vector<std::uint8_t> wrong(1000, 0x55);
  const std::string error = error_of(port, wrong, {.attempts = 2});
  EXPECT_NE(error.find("is this its firmware?"), std::string::npos) << error;
}

TEST(FalconFirmware, ABootLoaderThatSaysNothingPointsToThePowerSupply) {
  test::FalconEmulator device(firmware());
  device.troubles.deaf_hellos = 1'000'000;
  MemoryPort port(device);
  const std::string error = error_of(port, firmware(), {.attempts = 2});
  EXPECT_NE(error.find("power supply"), std::string::npos) << error;
}

TEST(FalconFirmware, UnpluggingAtAnyPointEndsInAnError) {
  // a probe, the handshake, load mode and 17 chunks
  for (std::size_t writes = 0; writes < 30; ++writes) {
    test::FalconEmulator device(firmware());
    MemoryPort port(device);
    port.writes_left = writes;
    const std::string error = error_of(port, firmware(), {.attempts = 2, .probes = 1});
    EXPECT_EQ(error.empty(), writes >= 21) << writes << ": " << error;
  }
}

}  // namespace
}  // namespace haptic::drivers::falcon
