#include "drivers/velocity_estimate.h"

#include <gtest/gtest.h>

#include <cmath>

namespace haptic::drivers {
namespace {

constexpr Nanoseconds kMillisecond = 1'000'000;

// From rest into 1 m/s a first-order lag tells 1 - exp(-t / lag), however the time is cut into samples.
TEST(VelocityEstimate, LagsBehindAStepByItsTimeConstant) {
  for (const Nanoseconds period : {kMillisecond, 4 * kMillisecond}) {
    VelocityEstimate estimate(0.008);
    for (Nanoseconds t = 0; t < 8 * kMillisecond; t += period) {
      estimate.take(t, {static_cast<double>(t) * 1e-9, 0.0, 0.0});
    }
    const double told = estimate.take(8 * kMillisecond, {0.008, 0.0, 0.0}).x;
    EXPECT_NEAR(told, 1.0 - std::exp(-1.0), 1e-12);
  }
}

TEST(VelocityEstimate, TheFirstPositionIsNoMovement) {
  VelocityEstimate estimate(0.01);
  EXPECT_EQ(estimate.take(5, {1.0, 2.0, 3.0}), glm::dvec3(0.0));
  estimate.take(5 + kMillisecond, {2.0, 2.0, 3.0});
  estimate.reset();
  EXPECT_EQ(estimate.take(5 + 2 * kMillisecond, {9.0, 9.0, 9.0}), glm::dvec3(0.0));
}

TEST(VelocityEstimate, ATimeThatStandsStillOrGoesBackChangesNothing) {
  VelocityEstimate estimate(0.01);
  estimate.take(0, {0.0, 0.0, 0.0});
  const glm::dvec3 before = estimate.take(kMillisecond, {0.001, 0.0, 0.0});
  EXPECT_EQ(estimate.take(kMillisecond, {0.5, 0.0, 0.0}), before);
  EXPECT_EQ(estimate.take(0, {0.5, 0.0, 0.0}), before);
}

}  // namespace
}  // namespace haptic::drivers
