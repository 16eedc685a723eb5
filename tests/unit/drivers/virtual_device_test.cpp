#include "drivers/virtual/virtual_device.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "rt/allocation_guard.h"

namespace haptic::drivers {
namespace {

constexpr Nanoseconds kMillisecond = 1'000'000;

TEST(VirtualDevice, HasNoSampleUntilItWasPlaced) {
  VirtualDevice device("mouse");
  device.start();
  DeviceSample sample;
  EXPECT_FALSE(device.read(0, sample));
  device.place({.time = 7, .position = {0.1, 0.2, 0.3}, .velocity = {1.0, 0.0, 0.0}, .buttons = 5}, true);
  ASSERT_TRUE(device.read(kMillisecond, sample));
  EXPECT_EQ(sample.time, 7);
  EXPECT_EQ(sample.position, glm::dvec3(0.1, 0.2, 0.3));
  EXPECT_EQ(sample.velocity, glm::dvec3(1.0, 0.0, 0.0));
  EXPECT_EQ(sample.buttons, 5U);
}

TEST(VirtualDevice, ASampleThatIsNotToldAgainKeepsItsTimeAndSoGrowsOld) {
  VirtualDevice device("mouse");
  device.place({.time = 7}, true);
  DeviceSample sample;
  for (Nanoseconds now = kMillisecond; now < 50 * kMillisecond; now += kMillisecond) {
    ASSERT_TRUE(device.read(now, sample));
    EXPECT_EQ(sample.time, 7);
  }
}

// 1 mm in each millisecond is 1 m/s, which the estimate has reached but for exp(-10) after ten of its lags.
TEST(VirtualDevice, KnowsItsVelocityFromItsPlacesIfNobodyTellsIt) {
  VirtualDevice device("mouse");
  DeviceSample sample;
  for (int n = 0; n <= 200; ++n) {
    device.place({.time = n * kMillisecond, .position = {0.0, n * 1e-3, 0.0}}, false);
  }
  ASSERT_TRUE(device.read(200 * kMillisecond, sample));
  EXPECT_NEAR(sample.velocity.y, 1.0, 2.0 * std::exp(-10.0));
}

TEST(VirtualDevice, APairOfPlacesThatComeTogetherIsNoHighSpeed) {
  VirtualDevice device("mouse");
  DeviceSample sample;
  device.place({.time = 0}, false);
  device.place({.time = 10'000, .position = {0.005, 0.0, 0.0}}, false);  // 5 mm in 10 us: 500 m/s
  ASSERT_TRUE(device.read(kMillisecond, sample));
  // at most distance / lag
  EXPECT_LE(sample.velocity.x, 0.005 / kVelocityLag);
}

TEST(VirtualDevice, ReturnsTheForceUntilItExpires) {
  VirtualDevice device("mouse");
  EXPECT_EQ(device.live_force(0).force, glm::dvec3(0.0));
  device.write(0, {.expires = 2 * kMillisecond, .force = {1.0, 2.0, 3.0}, .torque = {0.0, 0.1, 0.0}});
  const ForceCommand live = device.live_force(2 * kMillisecond - 1);
  EXPECT_EQ(live.force, glm::dvec3(1.0, 2.0, 3.0));
  EXPECT_EQ(live.torque, glm::dvec3(0.0, 0.1, 0.0));
  EXPECT_EQ(live.expires, 2 * kMillisecond);
  EXPECT_EQ(device.live_force(2 * kMillisecond).force, glm::dvec3(0.0));
  EXPECT_EQ(device.live_force(2 * kMillisecond).expires, 0);
}

TEST(VirtualDevice, AForceThatIsNoNumberIsNone) {
  VirtualDevice device("mouse");
  device.write(0, {.expires = 2 * kMillisecond, .force = {std::nan(""), 0.0, 0.0}});
  EXPECT_EQ(device.live_force(0).force, glm::dvec3(0.0));
}

TEST(VirtualDevice, IsRealTimeSafe) {
  VirtualDevice device("mouse");
  DeviceSample sample;
  const rt::AllocationGuard watch;
  for (Nanoseconds now = 0; now < 1000 * kMillisecond; now += kMillisecond) {
    device.place({.time = now}, false);
    device.read(now, sample);
    device.write(now, {.expires = now + 1});
    device.live_force(now);
  }
}

}  // namespace
}  // namespace haptic::drivers
