#include "drivers/spacemouse/spacemouse_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

namespace haptic::drivers::spacemouse {
namespace {

constexpr Nanoseconds kMillisecond = 1'000'000;

Decoder pushed(std::uint8_t id, int x) {
  Decoder decoder;
  const auto raw = static_cast<std::uint16_t>(x);
  decoder.take(std::vector<std::uint8_t>{id, static_cast<std::uint8_t>(raw),
                                         static_cast<std::uint8_t>(raw >> 8U), 0, 0, 0, 0});
  return decoder;
}

/// `milliseconds` in which a report comes every 8 ms.
DeviceSample run(Motion& motion, const Decoder& decoder, int milliseconds, Nanoseconds& now) {
  DeviceSample last;
  for (int i = 0; i < milliseconds; ++i) {
    now += kMillisecond;
    if (i % 8 == 0) motion.take(decoder, now);
    const auto sample = motion.advance(now);
    EXPECT_TRUE(sample);
    if (sample) last = *sample;
  }
  return last;
}

TEST(SpacemouseMotion, DeflectionIsVelocity) {
  Motion motion({.speed = 0.1, .reach = 1.0});
  Nanoseconds now = 0;
  motion.advance(now);
  const DeviceSample sample = run(motion, pushed(1, 175), 1000, now);
  EXPECT_NEAR(sample.position.x, 0.05, 1e-12);  // half of 0.1 m/s for 1 s
  EXPECT_NEAR(sample.velocity.x, 0.05, 1e-9);
  EXPECT_EQ(sample.orientation, glm::dquat(1.0, 0.0, 0.0, 0.0));
}

TEST(SpacemouseMotion, TurningIsARateToo) {
  Motion motion({.turn_rate = 0.5});
  Nanoseconds now = 0;
  motion.advance(now);
  const DeviceSample sample = run(motion, pushed(2, 350), 1000, now);
  EXPECT_NEAR(sample.orientation.w, std::cos(0.25), 1e-9);  // half of 0.5 rad
  EXPECT_NEAR(sample.orientation.x, std::sin(0.25), 1e-9);
  EXPECT_EQ(sample.position, glm::dvec3(0.0));
}

TEST(SpacemouseMotion, NoCoordinateIsBeyondReachAndItStandsStillThere) {
  Motion motion({.speed = 1.0, .reach = 0.05});
  Nanoseconds now = 0;
  motion.advance(now);
  const DeviceSample sample = run(motion, pushed(1, -350), 1000, now);
  EXPECT_EQ(sample.position.x, -0.05);
  EXPECT_EQ(sample.velocity.x, 0.0);
}

TEST(SpacemouseMotion, AxesCanBeInverted) {
  Motion motion({.reach = 1.0, .translation_signs = {-1.0, 1.0, 1.0}, .rotation_signs = {-1.0, 1.0, 1.0}});
  Nanoseconds now = 0;
  motion.advance(now);
  EXPECT_LT(run(motion, pushed(1, 350), 100, now).position.x, 0.0);
  EXPECT_LT(run(motion, pushed(2, 350), 100, now).orientation.x, 0.0);
}

TEST(SpacemouseMotion, SilenceAtRestIsRest) {
  Motion motion({});
  Nanoseconds now = 0;
  run(motion, pushed(1, 350), 100, now);
  const DeviceSample rest = run(motion, pushed(1, 0), 1, now);
  now += 10'000 * kMillisecond;
  const auto later = motion.advance(now);
  ASSERT_TRUE(later);
  EXPECT_EQ(later->time, now);
  EXPECT_EQ(later->position, rest.position);
}

TEST(SpacemouseMotion, SilenceWhileDeflectedIsALossUntilTheNextReport) {
  Motion motion({});
  Nanoseconds now = 0;
  const DeviceSample last = run(motion, pushed(1, 350), 100, now);
  EXPECT_TRUE(motion.advance(now + 90 * kMillisecond));
  EXPECT_FALSE(motion.advance(now + 110 * kMillisecond));
  now += 500 * kMillisecond;
  EXPECT_FALSE(motion.advance(now));
  const DeviceSample again = run(motion, pushed(1, 0), 1, now);
  EXPECT_NEAR(again.position.x, last.position.x, 0.1 * 0.051) << "the gap is not made up";
}

}  // namespace
}  // namespace haptic::drivers::spacemouse
