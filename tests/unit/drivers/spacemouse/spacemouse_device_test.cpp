#include "drivers/spacemouse/spacemouse_device.h"

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "drivers/device_error.h"
#include "rt/tick_clock.h"
#include "tests/support/eventually.h"
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

  bool read() { return device->read(rt::monotonic_ns(), sample); }

  std::string error_of() {
    try {
      device->start();
    } catch (const DeviceError& error) {
      return error.what();
    }
    return "";
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
  EXPECT_EQ(led, (Bytes{4, 1}));
  ASSERT_TRUE(eventually([&] { return read(); })) << "at rest it sends nothing, and is there";
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
  EXPECT_EQ(error_of(), "device \"puck\": no SpaceMouse is connected");
}

TEST_F(SpacemouseDevice, OfTwoTheOneWithTheSerialIsTaken) {
  plug_in({.vendor = 0x046d, .product = 0xc626, .serial = "A"});
  const test::HidMock second(bus, {.vendor = 0x046d, .product = 0xc626, .serial = "B", .port = 2, .node = 1});
  EXPECT_NE(error_of().find("2 of SpaceMouse are connected"), std::string::npos);
  device = make_spacemouse({.name = "puck", .serial = "B"});
  EXPECT_EQ(error_of(), "");
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

}  // namespace
}  // namespace haptic::drivers::spacemouse
