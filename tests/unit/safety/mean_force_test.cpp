#include "safety/mean_force.h"

#include <gtest/gtest.h>

#include <cmath>

#include "safety/limits.h"

namespace haptic::safety {
namespace {

constexpr double kDt = 0.001;
constexpr double kRounding = 1e-10;

// d mean / dt = (F - mean) / T from 0: mean = F (1 - exp(-t / T)). In steps of dt by backward Euler the
// exponential is (T / (T + dt))^n, which is larger by n dt^2 / (2 T^2) of itself at the most.
TEST(MeanForce, ComesUpToASteadyForceExponentially) {
  MeanForce mean(kUnlimited, 10.0);
  for (int i = 0; i < 10000; ++i) mean.take(3.0, kDt);
  EXPECT_NEAR(mean.mean(), 3.0 * (1.0 - std::pow(10.0 / 10.001, 10000)), kRounding);
  EXPECT_NEAR(mean.mean(), 3.0 * (1.0 - std::exp(-1.0)), 1e-4);
}

TEST(MeanForce, ForgetsWhenThereIsNoForce) {
  MeanForce mean(kUnlimited, 1.0);
  for (int i = 0; i < 20000; ++i) mean.take(2.0, kDt);
  ASSERT_NEAR(mean.mean(), 2.0, 1e-6);
  for (int i = 0; i < 1000; ++i) mean.take(0.0, kDt);
  EXPECT_NEAR(mean.mean(), 2.0 * std::exp(-1.0), 1e-3);
}

TEST(MeanForce, BoundsNothingBelowNineTenthsOfItsLimitAndToTheLimitThere) {
  MeanForce mean(1.0, 1.0);
  EXPECT_EQ(mean.bound(5.0), 5.0);
  while (mean.mean() < 0.9) {
    EXPECT_EQ(mean.bound(5.0), 5.0);
    mean.take(5.0, kDt);
  }
  while (mean.mean() < 0.95) mean.take(1.0, 1e-6);
  EXPECT_NEAR(mean.bound(5.0), 3.0, 1e-3);  // half way down from 5 to 1
  while (mean.mean() < 1.0) mean.take(5.0, 1e-6);
  EXPECT_EQ(mean.bound(5.0), 1.0);
}

// At the limit the bound is the limit, and a mean is not raised by a force that it does not exceed.
TEST(MeanForce, AForceAtItsBoundNeverBringsTheMeanBeyondTheLimit) {
  for (const double limit : {0.5, 1.0, 4.9}) {
    MeanForce mean(limit, 10.0);
    double last = 5.0;
    double largest_step = 0.0;
    for (int i = 0; i < 200000; ++i) {
      const double force = mean.bound(5.0);
      mean.take(force, kDt);
      EXPECT_LE(mean.mean(), limit);
      largest_step = std::max(largest_step, std::abs(force - last));
      last = force;
    }
    EXPECT_NEAR(last, limit, 0.01 * limit);
    // smoothly: the bound falls by (F - L) / (L / 10) of what the mean rises by, which is F dt / T at most
    EXPECT_LE(largest_step, (5.0 - limit) / (0.1 * limit) * 5.0 * kDt / 10.0 * 1.001);
  }
}

TEST(MeanForce, ALimitAboveTheLargestForceBoundsNothing) {
  MeanForce mean(6.0, 0.1);
  for (int i = 0; i < 10000; ++i) mean.take(5.0, kDt);
  EXPECT_EQ(mean.bound(5.0), 5.0);
  MeanForce unlimited(kUnlimited, 0.1);
  for (int i = 0; i < 10000; ++i) unlimited.take(5.0, kDt);
  EXPECT_EQ(unlimited.bound(5.0), 5.0);
}

}  // namespace
}  // namespace haptic::safety
