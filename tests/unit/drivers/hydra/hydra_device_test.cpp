#include "drivers/hydra/hydra_device.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <glm/geometric.hpp>
#include <optional>
#include <string>
#include <thread>

#include "drivers/hydra/hydra_protocol.h"
#include "rt/tick_clock.h"
#include "tests/support/device_life.h"
#include "tests/support/hid_mock.h"
#include "tests/unit/drivers/hydra/hydra_reports.h"

namespace haptic::drivers::hydra {
namespace {

using std::chrono::milliseconds;
using test::eventually;

/// A base that sends motion once it has been asked for it the `needed`-th time.
class HydraDevice : public testing::Test {
 protected:
  void plug_in(int needed) {
    motion.emplace(bus, test::HidIdentity{.vendor = 0x1532, .product = 0x0300, .interface_number = 0});
    control.emplace(
        bus,
        test::HidIdentity{.vendor = 0x1532, .product = 0x0300, .interface_number = 1, .usage = 5, .node = 1},
        test::HidFunction{.set_feature = [this](std::span<const std::uint8_t> report) {
          const auto wanted = mode_report(Mode::kMotion);
          if (std::equal(report.begin(), report.end(), wanted.begin(), wanted.end())) ++asked;
        }});
    sender = std::thread([this, needed] {
      const auto report =
          motion_report({.millimetres = {100, 0, 0}}, {.millimetres = {-100, 50, 0}, .buttons = 0x81});
      while (!ending) {
        if (asked >= needed && !gone) motion->send(report);
        std::this_thread::sleep_for(milliseconds(4));
      }
    });
  }

  ~HydraDevice() override {
    ending = true;
    if (sender.joinable()) sender.join();
  }

  static std::unique_ptr<Device> wand(std::size_t number) {
    return make_hydra({.name = "wand",
                       .wand = number,
                       .first_report = milliseconds(100),
                       .mode_change = milliseconds(300),
                       .attempts = 4});
  }

  test::MockBus bus;
  std::optional<test::HidMock> motion;
  std::optional<test::HidMock> control;
  std::atomic<int> asked{0};
  std::atomic<bool> gone{false};
  std::atomic<bool> ending{false};
  std::thread sender;
  DeviceSample sample;
};

TEST_F(HydraDevice, IsTurnedFromGamepadToMotionOnceForBothWands) {
  plug_in(2);
  const std::unique_ptr<Device> left = wand(0);
  const std::unique_ptr<Device> right = wand(1);
  left->start();
  ASSERT_TRUE(eventually([&] { return left->read(0, sample); }));
  EXPECT_EQ(asked, 2);
  EXPECT_NEAR(glm::distance(sample.position, glm::dvec3(-0.1, 0.0, 0.0)), 0.0, 1e-15);
  left->stop();
  right->start();
  ASSERT_TRUE(eventually([&] { return right->read(0, sample); }));
  EXPECT_EQ(asked, 2) << "it sends motion already";
  EXPECT_NEAR(glm::distance(sample.position, glm::dvec3(0.1, 0.05, 0.0)), 0.0, 1e-15);
  EXPECT_EQ(sample.buttons, 1U);
}

TEST_F(HydraDevice, OneThatSendsNoMotionIsToldToBePluggedInAgain) {
  plug_in(1000);
  const std::unique_ptr<Device> device = wand(0);
  device->start();
  const std::string reason = test::why_not_open(*device);
  EXPECT_NE(reason.find("plug it in again"), std::string::npos) << reason;
  EXPECT_GE(asked, 4);
}

TEST_F(HydraDevice, SilenceAndUnpluggingEndItsSamples) {
  plug_in(0);
  const std::unique_ptr<Device> device = wand(0);
  device->start();
  ASSERT_TRUE(eventually([&] { return device->read(0, sample); }));
  gone = true;
  EXPECT_TRUE(eventually([&] { return device->state().losses == 1; })) << "silent";
  EXPECT_FALSE(device->read(0, sample));
  gone = false;
  EXPECT_TRUE(eventually([&] { return device->read(0, sample); })) << "back";
  gone = true;
  motion->unplug();
  EXPECT_TRUE(eventually([&] { return !device->read(0, sample); })) << "unplugged";
  device->stop();
}

TEST_F(HydraDevice, WithoutOneTheErrorTellsSo) {
  const std::unique_ptr<Device> device = wand(0);
  device->start();
  EXPECT_EQ(test::why_not_open(*device), "no Razer Hydra is connected");
  plug_in(0);
  EXPECT_TRUE(test::reaches(*device, DevicePhase::kReady)) << "it is served when it is plugged in";
}

}  // namespace
}  // namespace haptic::drivers::hydra
