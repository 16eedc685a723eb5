// The driver against an emulated card, through the kernel's interface.

#include "drivers/phantom/phantom_device.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <optional>
#include <string>
#include <thread>

#include "rt/tick_clock.h"
#include "tests/support/device_life.h"
#include "tests/support/eventually.h"
#include "tests/support/phantom_mock.h"
#include "tests/unit/drivers/phantom/phantom_arm.h"

namespace haptic::drivers::phantom {
namespace {

using std::chrono::milliseconds;
using test::eventually;
using Motors = std::array<std::uint32_t, 3>;

constexpr Motors kRest{kNoTorque, kNoTorque, kNoTorque};

class PhantomDevice : public testing::Test {
 protected:
  // each request is a round trip to the emulation: it is given more time than the card is
  static PhantomSettings settings() {
    return {.name = "arm",
            .path = "/dev/phantom0",
            .calibration = toy_calibration(),
            .max_force = 5.0,
            .patience = milliseconds(2000),
            .silence = milliseconds(4000)};
  }

  void start(PhantomSettings wanted) {
    device = make_phantom(std::move(wanted));
    device->start();
  }

  bool read() { return device->read(rt::monotonic_ns(), sample); }

  void push(const glm::dvec3& force) {
    const Nanoseconds now = rt::monotonic_ns();
    device->write(now, {.expires = now + 2'000'000, .force = force});
  }

  Motors motors() const {
    const auto outputs = mock->state().outputs;
    return {outputs[0], outputs[1], outputs[2]};
  }

  test::MockBus bus;
  std::optional<test::PhantomMock> mock{std::in_place, bus};
  std::unique_ptr<Device> device;
  DeviceSample sample;
};

TEST_F(PhantomDevice, TellsItsPositionAndPushes) {
  start(settings());
  ASSERT_TRUE(eventually([&] { return read(); }));
  EXPECT_EQ(sample.position, glm::dvec3(0.0));
  // 1 N to the right is 0.2 N m at the base, of 500 words each, in output 1
  ASSERT_TRUE(eventually([&] {
    push({1.0, 0.0, 0.0});
    return motors() == Motors{2048, 2148, 2048};
  }));
  EXPECT_GT(mock->state().amp_toggles, 0U);
  // 10 counts are 0.01 rad
  mock->set_input(4, 10);
  EXPECT_TRUE(eventually([&] { return read() && std::abs(sample.position.x - 0.002) < 1e-6; }));
  device->stop();
}

TEST_F(PhantomDevice, AForceThatIsNotRenewedEndsByItself) {
  start(settings());
  ASSERT_TRUE(eventually([&] {
    push({1.0, 0.0, 0.0});
    return motors() == Motors{2048, 2148, 2048};
  }));
  EXPECT_TRUE(eventually([&] { return motors() == kRest; }));
  EXPECT_TRUE(read()) << "it still tells where it is";
  device->stop();
}

TEST_F(PhantomDevice, StoppingItLeavesNoTorqueAndNoSignOfLife) {
  start(settings());
  ASSERT_TRUE(eventually([&] {
    push({1.0, 0.0, 0.0});
    return motors() == Motors{2048, 2148, 2048};
  }));
  device->stop();
  EXPECT_EQ(motors(), kRest);
  const test::PhantomState state = mock->state();
  EXPECT_FALSE(state.is_running);
  EXPECT_EQ(state.control, 0U);
}

TEST_F(PhantomDevice, WhatTheLastProgramLeftInTheKernelIsNeverWritten) {
  mock->leave_behind({3000, 3000, 3000, 3000, 3000, 3000, 3000, 3000});
  start(settings());
  ASSERT_TRUE(eventually([&] { return mock->state().amp_toggles > 5; }));
  EXPECT_EQ(mock->state().motors, (std::vector<Motors>{kRest})) << "no torque, at once and always since";
  EXPECT_EQ(mock->state().outputs[3], 3000U) << "outputs that drive no motor are left alone";
  device->stop();
}

TEST_F(PhantomDevice, WhenInterruptsEndTheMotorsAreAtRestAndItIsLost) {
  PhantomSettings wanted = settings();
  wanted.silence = milliseconds(50);
  wanted.patience = milliseconds(1000);
  start(wanted);
  ASSERT_TRUE(eventually([&] {
    push({1.0, 0.0, 0.0});
    return motors() == Motors{2048, 2148, 2048};
  }));
  mock->set_interrupts(false);  // from now on the kernel writes nothing that it holds
  EXPECT_TRUE(eventually([&] {
    push({1.0, 0.0, 0.0});
    return motors() == kRest;
  }));
  EXPECT_TRUE(eventually([&] { return !read(); }));
  device->stop();
}

TEST_F(PhantomDevice, ARoundThatLastsTooLongEndsItsForceForGood) {
  PhantomSettings wanted = settings();
  wanted.patience = milliseconds(200);
  start(wanted);
  ASSERT_TRUE(eventually([&] {
    push({1.0, 0.0, 0.0});
    return motors() == Motors{2048, 2148, 2048};
  }));
  mock->delay_next(milliseconds(1000));
  EXPECT_TRUE(eventually([&] {
    push({1.0, 0.0, 0.0});
    return motors() == kRest && !mock->state().is_running;
  }));
  EXPECT_TRUE(eventually([&] { return !read(); }));
  device->stop();
  EXPECT_EQ(motors(), kRest);
}

TEST_F(PhantomDevice, WithoutACalibrationItTouchesNoRegister) {
  PhantomSettings wanted = settings();
  wanted.calibration.reset();
  start(wanted);
  EXPECT_EQ(device->info().max_force, 0.0);
  for (int i = 0; i < 20; ++i) {
    push({1.0, 0.0, 0.0});
    EXPECT_FALSE(read());
    std::this_thread::sleep_for(milliseconds(2));
  }
  device->stop();
  EXPECT_EQ(mock->state().ioctls, 0U);
}

TEST_F(PhantomDevice, WithoutForceItReadsAndWritesNoOutput) {
  PhantomSettings wanted = settings();
  wanted.max_force = 0.0;
  start(wanted);
  ASSERT_TRUE(eventually([&] { return read(); }));
  for (int i = 0; i < 20; ++i) {
    push({1.0, 0.0, 0.0});
    std::this_thread::sleep_for(milliseconds(2));
  }
  device->stop();
  const test::PhantomState state = mock->state();
  EXPECT_EQ(state.writes, 0U);
  EXPECT_EQ(state.amp_toggles, 0U) << "nothing tells the amplifiers to live";
  EXPECT_FALSE(state.is_running);
}

TEST_F(PhantomDevice, ReadsNoRegisterThatTheCalibrationDoesNotName) {
  start(settings());
  ASSERT_TRUE(eventually([&] { return read(); }));
  device->stop();
  EXPECT_EQ(mock->state().read_mask, 0b0101'1100U);
}

TEST_F(PhantomDevice, ACardThatGoesAwayEndsItsSamplesAndStopStillReturns) {
  start(settings());
  ASSERT_TRUE(eventually([&] { return read(); }));
  mock->unplug();
  EXPECT_TRUE(eventually([&] { return !read(); }));
  device->stop();
}

TEST_F(PhantomDevice, TellsWhatToDoWhileThereIsNoCard) {
  PhantomSettings wanted = settings();
  wanted.path = "/dev/phantom7";
  start(wanted);
  EXPECT_EQ(test::why_not_open(*device),
            "/dev/phantom7: no such card; is the kernel's module \"phantom\" loaded (modprobe phantom)?");
  EXPECT_EQ(device->state().phase, DevicePhase::kAbsent);
}

}  // namespace
}  // namespace haptic::drivers::phantom
