#include "drivers/playback/playback_device.h"

#include <gtest/gtest.h>

#include "rt/allocation_guard.h"

namespace haptic::drivers {
namespace {

constexpr Nanoseconds kMillisecond = 1'000'000;

std::vector<PathPoint> one_metre_in_one_second() {
  return {{.time = 0.0, .position = {0.0, 0.0, 0.0}}, {.time = 1.0, .position = {1.0, 0.0, 0.0}}};
}

TEST(PlaybackDevice, HasNoSampleUntilStartedAndAfterStopped) {
  PlaybackDevice device("probe", one_metre_in_one_second(), false);
  DeviceSample sample;
  EXPECT_FALSE(device.read(0, sample));
  device.start();
  EXPECT_TRUE(device.read(0, sample));
  device.stop();
  EXPECT_FALSE(device.read(kMillisecond, sample));
}

TEST(PlaybackDevice, FollowsItsPathFromTheFirstReadOnWhateverTheClockSays) {
  for (const Nanoseconds start : {Nanoseconds{0}, Nanoseconds{987'654'321'012'345}}) {
    PlaybackDevice device("probe", one_metre_in_one_second(), false);
    device.start();
    DeviceSample sample;
    ASSERT_TRUE(device.read(start, sample));
    EXPECT_EQ(sample.position, glm::dvec3(0.0));
    ASSERT_TRUE(device.read(start + 250 * kMillisecond, sample));
    EXPECT_EQ(sample.position, glm::dvec3(0.25, 0.0, 0.0));
    EXPECT_EQ(sample.velocity, glm::dvec3(1.0, 0.0, 0.0));
    EXPECT_EQ(sample.time, start + 250 * kMillisecond);
    ASSERT_TRUE(device.read(start + 2000 * kMillisecond, sample));
    EXPECT_EQ(sample.position, glm::dvec3(1.0, 0.0, 0.0));
  }
}

TEST(PlaybackDevice, IsNotMovedByForces) {
  PlaybackDevice device("probe", {{.position = {0.1, 0.2, 0.3}}}, false);
  device.start();
  DeviceSample sample;
  for (Nanoseconds now = 0; now < 100 * kMillisecond; now += kMillisecond) {
    ASSERT_TRUE(device.read(now, sample));
    device.write(now, {.expires = now + 3 * kMillisecond, .force = {5.0, 5.0, 5.0}});
  }
  EXPECT_EQ(sample.position, glm::dvec3(0.1, 0.2, 0.3));
}

TEST(PlaybackDevice, IsRealTimeSafe) {
  PlaybackDevice device("probe", one_metre_in_one_second(), true);
  device.start();
  DeviceSample sample;
  const rt::AllocationGuard watch;
  for (Nanoseconds now = 0; now < 3000 * kMillisecond; now += kMillisecond) {
    device.read(now, sample);
    device.write(now, {});
  }
}

}  // namespace
}  // namespace haptic::drivers
