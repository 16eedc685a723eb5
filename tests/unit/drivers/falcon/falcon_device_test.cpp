// The whole driver, through libusb, against the emulated device. Nothing here is timed: a force is written as
// if it had been written a second later, so that it does not expire while the machine is busy.

#include "drivers/falcon/falcon_device.h"

#include <gtest/gtest.h>

#include <chrono>
#include <glm/geometric.hpp>
#include <optional>
#include <string>
#include <thread>

#include "drivers/device_error.h"
#include "rt/tick_clock.h"
#include "tests/support/device_life.h"
#include "tests/support/falcon_emulator.h"
#include "tests/support/usb_mock.h"

namespace haptic::drivers::falcon {
namespace {

using test::eventually;

constexpr Nanoseconds kSecond = 1'000'000'000;

std::vector<std::uint8_t> firmware() {
  std::vector<std::uint8_t> bytes(150);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(i * 3);
  return bytes;
}

class FalconDevice : public testing::Test {
 protected:
  void plug_in(std::vector<std::uint8_t> needs = {}, const std::string& serial = "", int port = 1) {
    emulator = test::FalconEmulator(std::move(needs));
    mock.emplace(
        bus, test::UsbIdentity{0x0403, 0xcb48, serial, port},
        test::UsbFunction{.control = [this](std::uint8_t request,
                                            std::uint16_t value) { emulator.control(request, value); },
                          .out = [this](std::span<const std::uint8_t> bytes) { emulator.receive(bytes); },
                          .in = [this](std::size_t most) { return emulator.send(most); }});
  }

  /// Replies count as fresh for a second: the machine may be busy.
  static FalconSettings settings() {
    return {.name = "right", .control = {.reply_age = kSecond}, .boot = {.attempts = 2, .handshakes = 3}};
  }

  void homed_at(const glm::dvec3& position) {
    mock->with_lock([&] {
      emulator.set_homed(kAllHomed);
      emulator.hold_at(position);
    });
  }

  bool read(Device& device) { return device.read(rt::monotonic_ns(), sample); }

  static void push(Device& device, const glm::dvec3& force) {
    const Nanoseconds later = rt::monotonic_ns() + kSecond;
    device.write(later, {.expires = later, .force = force});
  }

  glm::dvec3 felt() {
    glm::dvec3 force;
    mock->with_lock([&] { force = emulator.force(); });
    return force;
  }

  std::string error_of(FalconSettings falcon) {
    const std::unique_ptr<Device> device = make_falcon(std::move(falcon));
    device->start();
    return test::why_not_open(*device);
  }

  test::MockBus bus;
  test::FalconEmulator emulator;
  std::optional<test::UsbMock> mock;
  DeviceSample sample;
};

TEST_F(FalconDevice, LoadsItsFirmwareThenTellsTheGripAndPushesTheHandAndLetsGo) {
  plug_in(firmware());
  FalconSettings falcon = settings();
  falcon.firmware = firmware();
  falcon.world_from_base.position = {0.0, 0.0, -0.125};
  const std::unique_ptr<Device> device = make_falcon(std::move(falcon));
  EXPECT_EQ(device->info().max_force, 4.0);
  device->start();
  ASSERT_TRUE(test::reaches(*device, DevicePhase::kHoming));
  mock->with_lock([&] { EXPECT_EQ(emulator.stage(), test::FalconEmulator::Stage::kRunning); });
  EXPECT_FALSE(read(*device)) << "it is not homed";

  homed_at({0.01, 0.0, 0.125});
  ASSERT_TRUE(eventually([&] { return read(*device); }));
  EXPECT_NEAR(glm::distance(sample.position, glm::dvec3(0.01, 0.0, 0.0)), 0.0, 1e-4);

  const glm::dvec3 force(0.5, -1.0, 2.0);
  EXPECT_TRUE(eventually([&] {
    push(*device, force);
    return glm::distance(felt(), force) < 3 * 0.5 / 200.0;
  }));

  device->stop();
  EXPECT_EQ(emulator.motors(), (std::array<int, 3>{}));
  EXPECT_EQ(emulator.flags(), 1U) << "LEDs off, homing still asked for";
  EXPECT_EQ(emulator.broken_bytes(), 0U);
}

TEST_F(FalconDevice, AForceThatIsNotRenewedBecomesZeroByItself) {
  plug_in();
  const std::unique_ptr<Device> device = make_falcon(settings());
  device->start();
  homed_at(kCentre);
  ASSERT_TRUE(eventually([&] {
    push(*device, {0.0, 0.0, 2.0});
    return felt().z > 1.0;
  }));
  // the last one was written for a second from now
  EXPECT_TRUE(eventually([&] { return felt() == glm::dvec3(0.0); }));
  EXPECT_TRUE(read(*device)) << "the device itself is well";
}

TEST_F(FalconDevice, UnpluggingItEndsItsSamplesAndStopStillReturns) {
  plug_in();
  const std::unique_ptr<Device> device = make_falcon(settings());
  device->start();
  homed_at(kCentre);
  ASSERT_TRUE(eventually([&] { return read(*device); }));
  mock->unplug();
  EXPECT_TRUE(eventually([&] { return !read(*device); }));
  device->stop();
}

TEST_F(FalconDevice, ATransferThatFailsEndsItWithoutForce) {
  plug_in();
  const std::unique_ptr<Device> device = make_falcon(settings());
  device->start();
  homed_at(kCentre);
  ASSERT_TRUE(eventually([&] {
    push(*device, {0.0, 0.0, 2.0});
    return felt().z > 1.0;
  }));
  mock->fail_next_out();
  EXPECT_TRUE(eventually([&] {
    push(*device, {0.0, 0.0, 2.0});
    return !read(*device);
  }));
  EXPECT_TRUE(eventually([&] {
    bool is_let_go = false;
    mock->with_lock([&] { is_let_go = emulator.motors() == std::array<int, 3>{} && emulator.flags() == 1; });
    return is_let_go;
  })) << "it was told so while it could be, LEDs off";
  device->stop();
}

TEST_F(FalconDevice, ADeviceThatFallsSilentHasNoSample) {
  plug_in();
  FalconSettings falcon = settings();
  falcon.control.reply_age = kSecond / 5;
  const std::unique_ptr<Device> device = make_falcon(std::move(falcon));
  device->start();
  homed_at(kCentre);
  ASSERT_TRUE(eventually([&] { return read(*device); }));
  mock->with_lock([&] { emulator.troubles.silent = true; });
  EXPECT_TRUE(eventually([&] { return !read(*device); }));
  mock->with_lock([&] { emulator.troubles.silent = false; });
  EXPECT_TRUE(eventually([&] { return read(*device); })) << "and has one again when it speaks";
}

TEST_F(FalconDevice, CanBeStartedAgain) {
  plug_in();
  const std::unique_ptr<Device> device = make_falcon(settings());
  for (int round = 0; round < 2; ++round) {
    device->start();
    homed_at(kCentre);
    EXPECT_TRUE(eventually([&] { return read(*device); }));
    device->stop();
    EXPECT_FALSE(read(*device));
  }
}

TEST_F(FalconDevice, WithoutOneTheErrorTellsWhatIsMissing) {
  EXPECT_EQ(error_of(settings()), "no USB device 0403:cb48 is connected");
}

TEST_F(FalconDevice, WithoutFirmwareTheErrorNamesTheField) {
  plug_in(firmware());
  const std::string error = error_of(settings());
  EXPECT_NE(error.find("falcon.firmware"), std::string::npos) << error;
}

TEST_F(FalconDevice, OfTwoTheOneWithTheSerialIsTaken) {
  plug_in({}, "FT1");
  test::FalconEmulator other;
  const test::UsbMock second(bus, {0x0403, 0xcb48, "FT2", 2},
                             {.control = [&](auto request, auto value) { other.control(request, value); },
                              .out = [&](auto bytes) { other.receive(bytes); },
                              .in = [&](std::size_t most) { return other.send(most); }});
  EXPECT_EQ(
      error_of(settings()),
      "2 USB devices 0403:cb48 are connected, with the serials FT1 and FT2: name the one that is meant by "
      "its serial");
  FalconSettings falcon = settings();
  falcon.serial = "FT2";
  EXPECT_EQ(error_of(std::move(falcon)), "");
  EXPECT_EQ(emulator.packets(), 0U);
  EXPECT_GT(other.packets(), 0U);
  FalconSettings none = settings();
  none.serial = "FT3";
  EXPECT_NE(error_of(std::move(none)).find("0403:cb48 with serial FT3"), std::string::npos);
}

}  // namespace
}  // namespace haptic::drivers::falcon
