#include "safety/still_sample.h"

#include <gtest/gtest.h>

#include <cmath>

namespace haptic::safety {
namespace {

constexpr glm::dvec3 kPlace{0.1, 0.2, 0.3};

TEST(StillSample, CountsTicksWithTheSamePositionUnderForce) {
  StillSample still;
  still.take(10, true, kPlace);
  EXPECT_EQ(still.ticks(), 0U);
  still.take(11, true, kPlace);
  still.take(12, true, kPlace);
  EXPECT_EQ(still.ticks(), 2U);
}

TEST(StillSample, ALastBitThatChangesIsMotion) {
  StillSample still;
  for (std::uint64_t tick = 0; tick < 5; ++tick) still.take(tick, true, kPlace);
  ASSERT_EQ(still.ticks(), 4U);
  still.take(5, true, {std::nextafter(0.1, 1.0), 0.2, 0.3});
  EXPECT_EQ(still.ticks(), 0U);
}

TEST(StillSample, BeginsAnewWhenThereWasNoForce) {
  StillSample still;
  for (std::uint64_t tick = 0; tick < 5; ++tick) still.take(tick, true, kPlace);
  still.take(5, false, kPlace);
  EXPECT_EQ(still.ticks(), 0U);
  still.take(6, true, kPlace);
  EXPECT_EQ(still.ticks(), 1U);
}

TEST(StillSample, TicksThatWereMissedCount) {
  StillSample still;
  still.take(0, true, kPlace);
  still.take(40, true, kPlace);
  EXPECT_EQ(still.ticks(), 40U);
}

}  // namespace
}  // namespace haptic::safety
