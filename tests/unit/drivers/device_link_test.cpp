#include "drivers/device_link.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "rt/allocation_guard.h"

namespace haptic::drivers {
namespace {

constexpr Nanoseconds kMillisecond = 1'000'000;

TEST(DeviceLink, TellsTheNewestSampleUntilThereIsNone) {
  DeviceLink link;
  DeviceSample sample;
  EXPECT_FALSE(link.read(sample));
  link.publish({.time = 1, .position = {0.1, 0.0, 0.0}});
  link.publish({.time = 2, .position = {0.2, 0.0, 0.0}, .buttons = 5});
  ASSERT_TRUE(link.read(sample));
  EXPECT_EQ(sample.time, 2);
  EXPECT_EQ(sample.position.x, 0.2);
  EXPECT_EQ(sample.buttons, 5U);
  ASSERT_TRUE(link.read(sample)) << "it stays the newest";
  link.publish_nothing();
  EXPECT_FALSE(link.read(sample));
}

TEST(DeviceLink, AForceEndsWithItsExpiry) {
  DeviceLink link;
  link.write(0, {.expires = kMillisecond, .force = {1.0, 0.0, 0.0}, .torque = {0.0, 0.1, 0.0}});
  EXPECT_EQ(link.live_force(kMillisecond - 1).force, glm::dvec3(1.0, 0.0, 0.0));
  EXPECT_EQ(link.live_force(kMillisecond - 1).torque, glm::dvec3(0.0, 0.1, 0.0));
  EXPECT_EQ(link.live_force(kMillisecond).force, glm::dvec3(0.0));
  EXPECT_EQ(link.live_force(kMillisecond).torque, glm::dvec3(0.0));
}

TEST(DeviceLink, AForceThatIsNotRefreshedEndsAfterThreeMillisecondsWhateverItsExpiry) {
  DeviceLink link;
  link.write(0, {.expires = 1000 * kMillisecond, .force = {1.0, 0.0, 0.0}});
  EXPECT_EQ(link.live_force(3 * kMillisecond - 1).force.x, 1.0);
  EXPECT_EQ(link.live_force(3 * kMillisecond).force.x, 0.0);
  link.write(4 * kMillisecond, {.expires = 1000 * kMillisecond, .force = {2.0, 0.0, 0.0}});
  EXPECT_EQ(link.live_force(5 * kMillisecond).force.x, 2.0);
}

TEST(DeviceLink, ThereIsNoForceBeforeTheFirst) {
  DeviceLink link;
  EXPECT_EQ(link.live_force(-kMillisecond).force, glm::dvec3(0.0));
  EXPECT_EQ(link.live_force(0).force, glm::dvec3(0.0));
}

TEST(DeviceLink, AForceThatIsNoNumberIsNone) {
  DeviceLink link;
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    link.write(0, {.expires = kMillisecond, .force = {bad, 1.0, 1.0}});
    EXPECT_EQ(link.live_force(0).force, glm::dvec3(0.0));
    link.write(0, {.expires = kMillisecond, .force = {1.0, 1.0, 1.0}, .torque = {0.0, bad, 0.0}});
    EXPECT_EQ(link.live_force(0).force, glm::dvec3(0.0));
  }
}

// The base stands at (1, 2, 3) m, turned by a quarter about z: its x is the world's y.
TEST(DeviceLink, StandsInTheWorldAsItsBaseDoes) {
  const double half = std::sqrt(0.5);
  DeviceLink link({.position = {1.0, 2.0, 3.0}, .orientation = {half, 0.0, 0.0, half}});
  link.publish({.position = {0.1, 0.0, 0.0}, .velocity = {0.0, 0.5, 0.0}});
  DeviceSample sample;
  ASSERT_TRUE(link.read(sample));
  EXPECT_NEAR(glm::distance(sample.position, glm::dvec3(1.0, 2.1, 3.0)), 0.0, 1e-15);
  EXPECT_NEAR(glm::distance(sample.velocity, glm::dvec3(-0.5, 0.0, 0.0)), 0.0, 1e-15);
  EXPECT_NEAR(sample.orientation.z, half, 1e-15);

  link.write(0, {.expires = 1, .force = {0.0, 2.0, 0.0}, .torque = {0.0, 0.0, 0.3}});
  EXPECT_NEAR(glm::distance(link.live_force(0).force, glm::dvec3(2.0, 0.0, 0.0)), 0.0, 1e-15);
  EXPECT_NEAR(glm::distance(link.live_force(0).torque, glm::dvec3(0.0, 0.0, 0.3)), 0.0, 1e-15);
}

TEST(DeviceLink, IsRealTimeSafe) {
  DeviceLink link;
  DeviceSample sample;
  const rt::AllocationGuard watch;
  for (Nanoseconds now = 0; now < 1000; ++now) {
    link.publish({.time = now});
    link.read(sample);
    link.write(now, {.expires = now + 1});
    (void)link.live_force(now);
    link.publish_nothing();
  }
}

}  // namespace
}  // namespace haptic::drivers
