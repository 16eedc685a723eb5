#include "drivers/spacemouse/spacemouse_device.h"

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "drivers/io/udev/udev_monitor.h"
#include "rt/tick_clock.h"
#include "tests/support/device_life.h"
#include "tests/support/hid_mock.h"

namespace haptic::drivers::spacemouse {
namespace {

using test::eventually;
using Bytes = std::vector<std::uint8_t>;

class SpacemouseDevice : public testing::Test {
 protected:
  void plug_in(const test::HidIdentity& identity) {
    mock.emplace(bus, identity, test::HidFunction{.out = [this](std::span<const std::uint8_t> report) {
                   led.assign(report.begin(), report.end());
                 }});
  }

  Bytes lit() {
    Bytes last;
    mock->with_lock([&] { last = led; });
    return last;
  }

  bool read() { return device->read(rt::monotonic_ns(), sample); }

  std::string error_of() {
    device->start();
    return test::why_not_open(*device);
  }

  test::MockBus bus;
  std::optional<test::HidMock> mock;
  Bytes led;
  std::unique_ptr<Device> device = make_spacemouse({.name = "puck", .motion = {.reach = 0.03}});
  DeviceSample sample;
};

TEST_F(SpacemouseDevice, MovesAsItsPuckIsPushedAndTellsItsButtons) {
  plug_in({.vendor = 0x046d, .product = 0xc626});
  device->start();
  ASSERT_TRUE(eventually([&] { return read(); })) << "at rest it sends nothing, and is there";
  EXPECT_EQ(lit(), (Bytes{4, 1}));
  EXPECT_EQ(sample.position, glm::dvec3(0.0));
  mock->send(Bytes{3, 2, 0});
  ASSERT_TRUE(eventually([&] { return read() && sample.buttons == 2; }));
  ASSERT_TRUE(eventually([&] {
    mock->send(Bytes{1, 0x5E, 0x01, 0, 0, 0, 0});
    return read() && sample.position.x == 0.03;
  }));
  mock->send(Bytes{1, 0, 0, 0, 0, 0, 0});
  device->stop();
  EXPECT_EQ(led, (Bytes{4, 0}));
}

TEST_F(SpacemouseDevice, IsFoundByItsUsageWhateverItsProduct) {
  plug_in({.vendor = 0x256f, .product = 0xc6ff});
  EXPECT_EQ(error_of(), "");
}

TEST_F(SpacemouseDevice, AMouseOfTheSameMakerIsNone) {
  plug_in({.vendor = 0x256f, .product = 0xc650, .usage = 2});
  EXPECT_EQ(error_of(), "no SpaceMouse is connected");
}

TEST_F(SpacemouseDevice, OfTwoTheOneWithTheSerialIsTaken) {
  plug_in({.vendor = 0x046d, .product = 0xc626, .serial = "A"});
  const test::HidMock second(bus, {.vendor = 0x046d, .product = 0xc626, .serial = "B", .port = 2, .node = 1});
  EXPECT_EQ(error_of(),
            "2 SpaceMouse devices are connected, with the serials A and B: name the one that is meant by its "
            "serial");
  device = make_spacemouse({.name = "puck", .serial = "B"});
  EXPECT_EQ(error_of(), "");
  EXPECT_EQ(device->words().serial, "B");
  EXPECT_TRUE(led.empty()) << "the other one is left alone";
}

TEST_F(SpacemouseDevice, UnpluggingItEndsItsSamplesAndStopStillReturns) {
  plug_in({.vendor = 0x046d, .product = 0xc626});
  device->start();
  ASSERT_TRUE(eventually([&] { return read(); }));
  mock->unplug();
  EXPECT_TRUE(eventually([&] { return !read(); }));
  device->stop();
}

TEST_F(SpacemouseDevice, ComesWhenItIsPluggedInAndAgainEachTime) {
  EXPECT_EQ(error_of(), "no SpaceMouse is connected");
  for (std::uint32_t round = 1; round <= 3; ++round) {
    const int place = static_cast<int>(round);
    plug_in({.vendor = 0x046d, .product = 0xc626, .serial = "A", .port = place, .node = place});
    ASSERT_TRUE(test::reaches(*device, DevicePhase::kReady));
    EXPECT_TRUE(read());
    EXPECT_EQ(device->words().serial, "A");
    mock->unplug();
    ASSERT_TRUE(eventually([&] { return device->state().losses == round; }));
    mock.reset();
    ASSERT_TRUE(test::reaches(*device, DevicePhase::kAbsent));
    EXPECT_FALSE(read());
  }
  EXPECT_EQ(device->words().serial, "");
}

TEST_F(SpacemouseDevice, ShowsWhichOneItIsByItsLight) {
  plug_in({.vendor = 0x046d, .product = 0xc626});
  device->start();
  ASSERT_TRUE(test::reaches(*device, DevicePhase::kReady));
  EXPECT_TRUE(device->knows(DeviceAction::kIdentify));
  EXPECT_FALSE(device->knows(DeviceAction::kHome));
  device->request(DeviceAction::kIdentify);
  for (int blink = 0; blink < 2; ++blink) {
    EXPECT_TRUE(eventually([&] { return lit() == Bytes{4, 0}; }));
    EXPECT_TRUE(eventually([&] { return lit() == Bytes{4, 1}; }));
  }
}

TEST_F(SpacemouseDevice, UdevTellsWhenOneIsPluggedIn) {
  const std::unique_ptr<PlugMonitor> hid = io::watch_udev("hidraw");
  const std::unique_ptr<PlugMonitor> serial = io::watch_udev("tty");
  EXPECT_FALSE(hid->take());
  plug_in({.vendor = 0x046d, .product = 0xc626});
  EXPECT_TRUE(eventually([&] { return hid->take(); }));
  EXPECT_FALSE(hid->take()) << "once";
  EXPECT_FALSE(serial->take());
  mock.reset();
  EXPECT_FALSE(hid->take()) << "what goes is no news";
}

}  // namespace
}  // namespace haptic::drivers::spacemouse
