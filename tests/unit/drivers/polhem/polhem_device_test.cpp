// The driver, through hidapi, against an emulated arm that sends its next report when it is answered.

#include "drivers/polhem/polhem_device.h"

#include <gtest/gtest.h>

#include <atomic>
#include <optional>
#include <string>

#include "rt/tick_clock.h"
#include "tests/support/device_life.h"
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
    ++place;
    mock.emplace(bus,
                 test::HidIdentity{.vendor = 0x16c0,
                                   .product = 0x0486,
                                   .usage_page = 0xAB,
                                   .usage = 0,
                                   .port = place,
                                   .node = place},
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
  int place = 0;  // where it is plugged in: each time elsewhere
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
  EXPECT_TRUE(eventually([&] { return device->state().losses == 1; })) << "silent";
  EXPECT_FALSE(device->read(0, sample));
  silent = false;
  EXPECT_TRUE(eventually([&] { return device->read(0, sample); })) << "it is told to get going again";
  mock->unplug();
  EXPECT_TRUE(eventually([&] { return !device->read(0, sample); })) << "unplugged";
  device->stop();
}

TEST_F(PolhemDevice, WithoutOneTheErrorTellsSo) {
  device->start();
  EXPECT_EQ(test::why_not_open(*device), "no WoodenHaptics arm is connected");
}

TEST_F(PolhemDevice, ThatIsPluggedInAgainIsInNoKnownPoseUntilAPersonTellsThatItRests) {
  plug_in(64);
  device->start();
  ASSERT_TRUE(test::reaches(*device, DevicePhase::kReady)) << "at the start the config tells that it rests";
  mock->unplug();
  ASSERT_TRUE(eventually([&] { return device->state().losses == 1; }));
  mock.reset();
  ASSERT_TRUE(test::reaches(*device, DevicePhase::kAbsent));
  counts = {11, 22, 33};
  plug_in(64);
  ASSERT_TRUE(test::reaches(*device, DevicePhase::kHoming));
  EXPECT_FALSE(device->read(0, sample));
  EXPECT_TRUE(eventually([&] { return device->words().reason.find("calibrate") != std::string::npos; }));
  ASSERT_TRUE(device->knows(DeviceAction::kCalibrate));
  device->request(DeviceAction::kCalibrate);
  EXPECT_TRUE(test::reaches(*device, DevicePhase::kReady));
  ASSERT_TRUE(device->read(0, sample));
  EXPECT_NEAR(sample.position.z, 0.205, 1e-12);
}

}  // namespace
}  // namespace haptic::drivers::polhem
