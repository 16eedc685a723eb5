// The driver, through hidapi, against an emulated arm that sends its next report when it is answered.

#include "drivers/polhem/polhem_device.h"

#include <gtest/gtest.h>

#include <atomic>
#include <optional>
#include <string>

#include "drivers/device_error.h"
#include "rt/tick_clock.h"
#include "tests/support/eventually.h"
#include "tests/support/hid_mock.h"
#include "tests/unit/drivers/polhem/polhem_messages.h"

namespace haptic::drivers::polhem {
namespace {

using test::eventually;
constexpr Nanoseconds kSecond = 1'000'000'000;

class PolhemDevice : public testing::Test {
 protected:
  void plug_in(std::size_t report_bytes) {
    length = report_bytes;
    mock.emplace(bus, test::HidIdentity{.vendor = 0x16c0, .product = 0x0486, .usage_page = 0xAB, .usage = 0},
                 test::HidFunction{.out = [this](std::span<const std::uint8_t> report) { obey(report); }});
  }

  void obey(std::span<const std::uint8_t> report) {
    if (report.size() != length + 1 || report[0] != 0) ++broken;
    const std::span<const std::uint8_t> message = report.subspan(1);
    current = word_of(message, 2);
    if (word_of(message, 3) == 1) {
      for (std::size_t i = 0; i < 3; ++i) counts[i] = word_of(message, 4 + i);
    }
    if (silent) return;
    std::vector<std::uint8_t> next = words({counts[0], counts[1], counts[2], 0, 0, 0, 0});
    next.resize(length);
    mock->send(next);
  }

  test::MockBus bus;
  std::optional<test::HidMock> mock;
  std::size_t length = 0;
  std::array<int, 3> counts{11, 22, 33};
  std::atomic<int> current{0};  // of the third motor, mA
  std::atomic<int> broken{0};
  std::atomic<bool> silent{false};
  DeviceSample sample;
  std::unique_ptr<Device> device =
      make_polhem({.name = "arm",
                   .control = {.rest_counts = {0, 0, 6000}, .calibrate_at_start = true, .max_current = 2.0}});
};

TEST_F(PolhemDevice, IsCalibratedThenPushesAndIsLeftWithoutCurrent) {
  plug_in(64);
  device->start();
  ASSERT_TRUE(eventually([&] { return device->read(0, sample); })) << "it is told to get going";
  EXPECT_NEAR(sample.position.z, 0.205, 1e-12);
  EXPECT_EQ(broken, 0);
  // 2 N over 0.245 m through a twelfth and 0.0603 N m/A
  EXPECT_TRUE(eventually([&] {
    const Nanoseconds later = rt::monotonic_ns() + kSecond;
    device->write(later, {.expires = later, .force = {0.0, 0.0, 2.0}});
    return current == 677;
  }));
  device->stop();
  EXPECT_EQ(current, 0);
}

TEST_F(PolhemDevice, AnswersShortReportsWithShortOnes) {
  plug_in(14);
  device->start();
  ASSERT_TRUE(eventually([&] { return device->read(0, sample); }));
  EXPECT_LE(broken, 1) << "but for the first, before it knows";
  device->stop();
}

TEST_F(PolhemDevice, SilenceAndUnpluggingEndItsSamples) {
  plug_in(64);
  device->start();
  ASSERT_TRUE(eventually([&] { return device->read(0, sample); }));
  silent = true;
  EXPECT_TRUE(eventually([&] { return !device->read(0, sample); })) << "silent";
  silent = false;
  EXPECT_TRUE(eventually([&] { return device->read(0, sample); })) << "it is told to get going again";
  mock->unplug();
  EXPECT_TRUE(eventually([&] { return !device->read(0, sample); })) << "unplugged";
  device->stop();
}

TEST_F(PolhemDevice, WithoutOneTheErrorTellsSo) {
  try {
    device->start();
    FAIL() << "no exception";
  } catch (const DeviceError& error) {
    EXPECT_STREQ(error.what(), "device \"arm\": no WoodenHaptics arm is connected");
  }
}

}  // namespace
}  // namespace haptic::drivers::polhem
