#include "safety/limits.h"

#include <gtest/gtest.h>

namespace haptic::safety {
namespace {

TEST(Limits, OfEachLimitTheStrictestHolds) {
  const GuardLimits all{.max_force = 5.0, .max_force_rate = 500.0, .max_speed = 2.0, .max_energy = 1.0};
  const DeviceLimits own{.max_force = 3.0,
                         .max_force_rate = 1000.0,
                         .max_speed = 0.5,
                         .max_mean_force = 1.5,
                         .max_energy = 2.0,
                         .travel = {{-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0}}};
  const GuardLimits both = strictest(all, own);
  EXPECT_EQ(both.max_force, 3.0);
  EXPECT_EQ(both.max_force_rate, 500.0);
  EXPECT_EQ(both.max_speed, 0.5);
  EXPECT_EQ(both.max_mean_force, 1.5);
  EXPECT_EQ(both.max_energy, 1.0);
  EXPECT_EQ(both.travel.max, glm::dvec3(1.0));
}

TEST(Limits, ADeviceWithoutLimitsOfItsOwnHasThoseOfAll) {
  const GuardLimits all;
  const GuardLimits both = strictest(all, {});
  EXPECT_EQ(both.max_force, all.max_force);
  EXPECT_EQ(both.max_force_rate, all.max_force_rate);
  EXPECT_EQ(both.max_speed, all.max_speed);
  EXPECT_EQ(both.max_mean_force, kUnlimited);
  EXPECT_EQ(both.max_energy, all.max_energy);
  EXPECT_EQ(both.travel.min, TravelBox().min);
}

}  // namespace
}  // namespace haptic::safety
