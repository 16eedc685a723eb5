#include "safety/energy_observer.h"

#include <gtest/gtest.h>

#include "safety/limits.h"

namespace haptic::safety {
namespace {

constexpr double kDt = 0.001;
constexpr double kRounding = 1e-12;

/// A device with a new sample in each tick, along x.
class Along {
 public:
  explicit Along(double bound) : observer(bound) {}

  /// The force before was `force`; now the device is at `x`.
  void take(double force, double x) { observer.take({force, 0.0, 0.0}, kDt, ++time_, {x, 0.0, 0.0}); }

  EnergyObserver observer;

 private:
  std::int64_t time_ = 0;
};

TEST(EnergyObserver, CountsTheWorkOfTheForceBetweenTwoSamples) {
  Along along(1.0);
  along.take(7.0, 0.5);  // the first sample is where it begins
  EXPECT_EQ(along.observer.energy(), 0.0);
  along.take(2.0, 0.51);  // 2 N over 10 mm along the force: given
  EXPECT_NEAR(along.observer.energy(), 0.02, kRounding);
  along.take(3.0, 0.50);  // 3 N over 10 mm against it: taken
  EXPECT_NEAR(along.observer.energy(), -0.01, kRounding);
}

TEST(EnergyObserver, AForceAcrossTheMotionDoesNoWork) {
  EnergyObserver observer(1.0);
  observer.take({}, kDt, 1, {0.0, 0.0, 0.0});
  observer.take({0.0, 5.0, -5.0}, kDt, 2, {0.1, 0.0, 0.0});
  EXPECT_EQ(observer.energy(), 0.0);
}

// A wall of stiffness k that is pressed to the depth n dx and left, a step dx in each tick: the force is that
// of the step before, on the way in too small by k dx and on the way out too large. What it gives is
//   k dx^2 (n + ... + 1) - k dx^2 ((n - 1) + ... + 0) = k dx^2 n
TEST(EnergyObserver, FindsWhatASampledWallGives) {
  constexpr double kStiffness = 100.0;
  constexpr double kStep = 1e-4;
  constexpr int kSteps = 100;
  Along along(1.0);
  double force = 0.0;
  const auto go_to = [&](int step) {
    along.take(force, -kStep * step);
    force = kStiffness * kStep * step;
  };
  for (int step = 0; step <= kSteps; ++step) go_to(step);
  EXPECT_LT(along.observer.energy(), 0.0) << "it takes energy on the way in";
  for (int step = kSteps - 1; step >= 0; --step) go_to(step);
  EXPECT_NEAR(along.observer.energy(), kStiffness * kStep * kStep * kSteps, kRounding);
}

// 1 N for one tick and 3 N for three, until a sample tells that the device has gone 10 mm: 2.5 N on the mean
TEST(EnergyObserver, TakesTheMeanOfTheForcesBetweenSamplesThatAreRarerThanTicks) {
  EnergyObserver observer(1.0);
  observer.take({}, kDt, 100, {0.0, 0.0, 0.0});
  observer.take({1.0, 0.0, 0.0}, kDt, 100, {0.0, 0.0, 0.0});
  observer.take({3.0, 0.0, 0.0}, kDt, 100, {0.0, 0.0, 0.0});
  observer.take({3.0, 0.0, 0.0}, kDt, 100, {0.0, 0.0, 0.0});
  EXPECT_EQ(observer.energy(), 0.0);
  observer.take({3.0, 0.0, 0.0}, kDt, 104, {0.01, 0.0, 0.0});
  EXPECT_NEAR(observer.energy(), 0.025, kRounding);
}

TEST(EnergyObserver, IsBeyondOnlyAboveItsBound) {
  Along along(0.5);
  along.take(0.0, 0.0);
  along.take(1.0, 0.5);  // exactly the bound
  EXPECT_FALSE(along.observer.is_beyond());
  along.take(1.0, 0.5001);
  EXPECT_TRUE(along.observer.is_beyond());
}

// 10 J were rubbed away on a rough wall: with all of them as a credit 10.5 J could be given unseen.
TEST(EnergyObserver, WhatWasTakenIsACreditOnlyUpToTheBound) {
  Along along(0.5);
  double x = 0.0;
  along.take(0.0, x);
  for (int i = 0; i < 1000; ++i) along.take(-1.0, x += 0.01);
  EXPECT_EQ(along.observer.energy(), -0.5);
  for (int i = 0; i < 99; ++i) along.take(1.0, x += 0.01);
  EXPECT_FALSE(along.observer.is_beyond());  // 0.99 J given
  for (int i = 0; i < 2; ++i) along.take(1.0, x += 0.01);
  EXPECT_TRUE(along.observer.is_beyond());  // 1.01 J
}

TEST(EnergyObserver, TheWayToWhereADeviceComesBackDoesNotCount) {
  Along along(1.0);
  along.take(0.0, 0.0);
  along.take(1.0, 0.1);
  along.observer.lose_place();
  along.take(1.0, 5.0);
  EXPECT_NEAR(along.observer.energy(), 0.1, kRounding);
  along.observer.reset();
  EXPECT_EQ(along.observer.energy(), 0.0);
}

TEST(EnergyObserver, WithoutABoundItOnlyTells) {
  Along along(kUnlimited);
  along.take(0.0, 0.0);
  along.take(1e6, 1e6);
  EXPECT_EQ(along.observer.energy(), 1e12);
  EXPECT_FALSE(along.observer.is_beyond());
}

}  // namespace
}  // namespace haptic::safety
