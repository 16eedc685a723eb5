// A Falcon that comes and goes, through libusb and its hot-plug notices, against the emulated device.

#include <gtest/gtest.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "drivers/falcon/falcon_device.h"
#include "drivers/io/usb/usb_monitor.h"
#include "rt/tick_clock.h"
#include "tests/support/device_life.h"
#include "tests/support/falcon_emulator.h"
#include "tests/support/usb_mock.h"

namespace haptic::drivers::falcon {
namespace {

using test::eventually;
using test::reaches;

constexpr Nanoseconds kSecond = 1'000'000'000;

/// One that is plugged in.
struct Plugged {
  Plugged(test::MockBus& bus, const std::string& serial, int port, std::vector<std::uint8_t> needs = {})
      : emulator(std::move(needs)),
        mock(bus, {0x0403, 0xcb48, serial, port},
             {.control = [this](auto request, auto value) { emulator.control(request, value); },
              .out = [this](auto bytes) { emulator.receive(bytes); },
              .in = [this](std::size_t most) { return emulator.send(most); }}) {}

  void home() {
    mock.with_lock([&] {
      emulator.set_homed(kAllHomed);
      emulator.hold_at(kCentre);
    });
  }
  unsigned flags() {
    unsigned flags = 0;
    mock.with_lock([&] { flags = emulator.flags(); });
    return flags;
  }

  test::FalconEmulator emulator;
  test::UsbMock mock;
};

class FalconLife : public testing::Test {
 protected:
  Plugged& plug_in(const std::string& serial = "FT1", int port = 1, std::vector<std::uint8_t> needs = {}) {
    return plugged.emplace(bus, serial, port, std::move(needs));
  }

  void unplug() {
    plugged->mock.unplug();
    EXPECT_TRUE(eventually([&] { return device->state().phase < DevicePhase::kOpening; }));
    plugged.reset();
    EXPECT_TRUE(reaches(*device, DevicePhase::kAbsent));
  }

  static std::unique_ptr<Device> falcon(FalconSettings settings = {.name = "right"}) {
    settings.control.reply_age = kSecond;
    return make_falcon(std::move(settings));
  }

  void start() { device->start(); }

  bool read() { return device->read(rt::monotonic_ns(), sample); }

  void expect_that_it_comes_back() {
    plug_in();
    EXPECT_TRUE(reaches(*device, DevicePhase::kHoming));
    plugged->home();
    EXPECT_TRUE(reaches(*device, DevicePhase::kReady));
    EXPECT_TRUE(read());
    EXPECT_EQ(device->words().serial, "FT1");
  }

  test::MockBus bus;
  std::unique_ptr<Device> device = falcon();
  std::optional<Plugged> plugged;
  DeviceSample sample;
};

TEST_F(FalconLife, AbsentAtTheStartItIsServedWhenItIsPluggedIn) {
  start();
  EXPECT_EQ(test::why_not_open(*device), "no USB device 0403:cb48 is connected");
  EXPECT_EQ(device->state().phase, DevicePhase::kAbsent);
  expect_that_it_comes_back();
  EXPECT_EQ(device->state().losses, 0U);
}

TEST_F(FalconLife, UnpluggedWhileItWaitsToBeOpenedTheOtherOneIsTaken) {
  plug_in("FT1", 1);
  std::optional<Plugged> second(std::in_place, bus, "FT2", 2);
  start();
  ASSERT_TRUE(reaches(*device, DevicePhase::kFound));
  EXPECT_TRUE(eventually(
      [&] { return device->words().reason.find("with the serials FT1 and FT2") != std::string::npos; }));
  second.reset();
  EXPECT_TRUE(reaches(*device, DevicePhase::kHoming));
  EXPECT_EQ(device->words().serial, "FT1");
}

TEST_F(FalconLife, TwoWithoutSerialsAreToldThatNothingTellsThemApart) {
  plug_in("", 1);
  const Plugged second(bus, "", 2);
  start();
  EXPECT_NE(test::why_not_open(*device).find("have no serial by which to tell them apart"),
            std::string::npos);
}

TEST_F(FalconLife, UnpluggedWhileItsFirmwareIsStarted) {
  device = falcon({.name = "right", .firmware = {1, 2, 3}, .boot = {.attempts = 1000, .handshakes = 1000}});
  plug_in("FT1", 1, {1, 2, 3}).mock.with_lock([&] { plugged->emulator.troubles.deaf_hellos = 1'000'000; });
  start();
  ASSERT_TRUE(reaches(*device, DevicePhase::kOpening));
  EXPECT_EQ(device->words().reason, "its firmware is started");
  unplug();
  EXPECT_EQ(device->state().losses, 0U) << "it had not been opened";
  expect_that_it_comes_back();
}

TEST_F(FalconLife, UnpluggedWhileItIsHomed) {
  plug_in();
  start();
  ASSERT_TRUE(reaches(*device, DevicePhase::kHoming));
  EXPECT_TRUE(eventually([&] { return device->words().reason.find("grip") != std::string::npos; }));
  unplug();
  EXPECT_EQ(device->state().losses, 1U);
  expect_that_it_comes_back();
}

TEST_F(FalconLife, UnpluggedWhileItIsReady) {
  plug_in().home();
  start();
  ASSERT_TRUE(reaches(*device, DevicePhase::kReady));
  unplug();
  EXPECT_FALSE(read());
  EXPECT_EQ(device->state().losses, 1U);
  expect_that_it_comes_back();
}

TEST_F(FalconLife, UnpluggedWhileItPushesItComesBackWithoutForce) {
  plug_in().home();
  start();
  ASSERT_TRUE(reaches(*device, DevicePhase::kReady));
  const auto push = [&](double newtons) {
    const Nanoseconds now = rt::monotonic_ns();
    device->write(now, {.expires = now + 3'000'000, .force = {0.0, 0.0, newtons}});
  };
  ASSERT_TRUE(eventually([&] {
    push(2.0);
    bool is_pushed = false;
    plugged->mock.with_lock([&] { is_pushed = plugged->emulator.motors() != std::array<int, 3>{}; });
    return is_pushed;
  }));
  unplug();
  expect_that_it_comes_back();
  plugged->mock.with_lock([&] { EXPECT_EQ(plugged->emulator.motors(), (std::array<int, 3>{})); });
}

TEST_F(FalconLife, APowerSupplyThatIsPulledOutIsALossAndItsFirmwareIsStartedAgain) {
  device = falcon({.name = "right", .control = {.reply_age = kSecond}});
  plug_in().home();
  start();
  ASSERT_TRUE(reaches(*device, DevicePhase::kReady));
  plugged->mock.with_lock([&] { plugged->emulator.troubles.silent = true; });
  EXPECT_TRUE(eventually([&] { return device->state().losses == 1; }));
  plugged->mock.with_lock([&] { plugged->emulator.troubles.silent = false; });
  EXPECT_TRUE(reaches(*device, DevicePhase::kReady));
}

TEST_F(FalconLife, OneThatDropsAgainAndAgainIsToldSo) {
  start();
  for (int drop = 1; drop <= 3; ++drop) {
    plug_in();
    ASSERT_TRUE(reaches(*device, DevicePhase::kHoming));
    plugged->mock.unplug();
    ASSERT_TRUE(eventually([&] { return device->state().losses == static_cast<std::uint32_t>(drop); }));
    if (drop > 1) {
      const std::string told = std::to_string(drop) + " times in a row";
      EXPECT_TRUE(eventually([&] { return device->words().reason.find(told) != std::string::npos; }))
          << device->words().reason;
    }
    plugged.reset();
    ASSERT_TRUE(reaches(*device, DevicePhase::kAbsent));
  }
}

TEST_F(FalconLife, TwoAlikeAreEachServedByItsSerialWhereverTheyArePluggedIn) {
  device = falcon({.name = "right", .serial = "FT1"});
  const std::unique_ptr<Device> other = falcon({.name = "right", .serial = "FT2"});
  start();
  other->start();
  plug_in("FT1", 1).home();
  std::optional<Plugged> second(std::in_place, bus, "FT2", 2);
  ASSERT_TRUE(reaches(*device, DevicePhase::kReady));
  ASSERT_TRUE(reaches(*other, DevicePhase::kHoming));
  EXPECT_EQ(device->words().serial, "FT1");
  EXPECT_EQ(other->words().serial, "FT2");

  // each into the other's port
  second->mock.unplug();
  ASSERT_TRUE(eventually([&] { return other->state().losses == 1; }));
  second.reset();
  unplug();
  ASSERT_TRUE(reaches(*other, DevicePhase::kAbsent));
  second.emplace(bus, "FT2", 1);
  plug_in("FT1", 2).home();
  ASSERT_TRUE(reaches(*device, DevicePhase::kReady));
  ASSERT_TRUE(reaches(*other, DevicePhase::kHoming));
  EXPECT_EQ(device->words().serial, "FT1");
  EXPECT_EQ(other->words().serial, "FT2");
}

TEST_F(FalconLife, ShowsWhichOneItIsByGreenAndRedInTurn) {
  plug_in();
  start();
  ASSERT_TRUE(reaches(*device, DevicePhase::kHoming));
  EXPECT_TRUE(device->knows(DeviceAction::kIdentify));
  device->request(DeviceAction::kIdentify);
  constexpr unsigned kGreen = 2;
  constexpr unsigned kRed = 8;
  EXPECT_TRUE(eventually([&] { return (plugged->flags() & (kGreen | kRed)) == kGreen; }))
      << "not homed it is red";
  EXPECT_TRUE(eventually([&] { return (plugged->flags() & (kGreen | kRed)) == kRed; }));
}

TEST_F(FalconLife, HomedAgainItsPositionDoesNotCountMeanwhile) {
  plug_in().home();
  start();
  ASSERT_TRUE(reaches(*device, DevicePhase::kReady));
  EXPECT_TRUE(device->knows(DeviceAction::kHome));
  EXPECT_FALSE(device->knows(DeviceAction::kCalibrate));
  device->request(DeviceAction::kHome);
  ASSERT_TRUE(reaches(*device, DevicePhase::kHoming));
  EXPECT_FALSE(read());
  EXPECT_TRUE(eventually([&] {
    bool has_forgotten = false;
    plugged->mock.with_lock([&] { has_forgotten = plugged->emulator.homed() == 0; });
    return has_forgotten;
  })) << "it is told to forget its marks";
  EXPECT_TRUE(eventually([&] {
    plugged->home();  // a packet on its way may make it forget once more
    return device->state().phase == DevicePhase::kReady;
  }));
}

TEST(UsbMonitor, NoticesOnlyTheKindThatItWatches) {
  test::MockBus bus;
  const std::unique_ptr<PlugMonitor> falcons = io::watch_usb(0x0403, 0xcb48);
  const std::unique_ptr<PlugMonitor> others = io::watch_usb(0x0403, 0x6001);
  ASSERT_TRUE(falcons);
  EXPECT_FALSE(falcons->take());
  EXPECT_FALSE(falcons->descriptors().empty());
  const Plugged one(bus, "FT1", 1);
  EXPECT_TRUE(eventually([&] { return falcons->take(); }));
  EXPECT_FALSE(falcons->take()) << "once";
  EXPECT_FALSE(others->take());
}

}  // namespace
}  // namespace haptic::drivers::falcon
