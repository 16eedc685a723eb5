#include "servo/motion_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "rt/allocation_guard.h"

namespace haptic::servo {
namespace {

using drivers::Nanoseconds;

constexpr Nanoseconds kMillisecond = 1'000'000;
constexpr double kRounding = 1e-9;

constexpr MotionFilterSettings kWindow{
    .kind = MotionFilterKind::kAdaptiveWindow, .window = 0.02, .noise = 2e-5};

/// One position along x each millisecond.
class Track {
 public:
  explicit Track(const MotionFilterSettings& settings) : filter(settings, 1000.0) {}

  Motion at(double x) {
    time += kMillisecond;
    return tell(x);
  }
  Motion tell(double x) {
    const Motion motion = filter.take({.time = time, .position = {x, 0.0, 0.0}});
    EXPECT_EQ(motion.velocity.y, 0.0);
    return motion;
  }

  MotionFilter filter;
  Nanoseconds time = 0;
};

TEST(AdaptiveWindow, TellsASteadyMotionExactly) {
  Track track(kWindow);
  EXPECT_EQ(track.at(0.0).velocity.x, 0.0) << "one position tells nothing";
  for (int i = 1; i < 100; ++i) {
    const Motion motion = track.at(0.25 * i * 1e-3);
    EXPECT_NEAR(motion.velocity.x, 0.25, kRounding);
    if (i > 25) {
      EXPECT_NEAR(motion.acceleration.x, 0.0, 1e-6);
    }
  }
}

// Encoder steps of 30 um put a position off by 15 um at the most, which is within the noise: at 10 mm/s the
// window is as long as it may be, 20 ms, and its ends are off by 2 * 15 um together. Differences of single
// ticks would tell 0 or 30 mm/s.
TEST(AdaptiveWindow, SmoothsTheStepsOfAnEncoder) {
  Track track(kWindow);
  for (int i = 0; i < 1000; ++i) {
    const double x = std::round(0.01 * i * 1e-3 / 30e-6) * 30e-6;
    const double velocity = track.at(x).velocity.x;
    if (i > 20) {
      EXPECT_NEAR(velocity, 0.01, 30e-6 / 0.02 + kRounding);
    }
  }
}

TEST(AdaptiveWindow, AJumpShowsInItsOwnSample) {
  Track track(kWindow);
  for (int i = 0; i < 50; ++i) track.at(0.0);
  EXPECT_NEAR(track.at(0.005).velocity.x, 5.0, kRounding);  // 5 mm in 1 ms
}

TEST(AdaptiveWindow, AStopShowsInItsOwnSample) {
  Track track(kWindow);
  for (int i = 0; i <= 50; ++i) track.at(0.5 * i * 1e-3);
  EXPECT_EQ(track.at(0.025).velocity.x, 0.0);
}

// x = a t^2 / 2 departs from its chord over T by a T^2 / 8: within twice 20 um at 1 m/s^2 for 17 ms, so that
// the velocity is that of 8.5 ms before, always. Its slope is the acceleration.
TEST(AdaptiveWindow, TellsASteadyAcceleration) {
  Track track(kWindow);
  for (int i = 0; i < 200; ++i) {
    const double t = i * 1e-3;
    const Motion motion = track.at(0.5 * t * t);
    if (i < 50) continue;
    EXPECT_NEAR(motion.velocity.x, t - 0.0085, 1e-6);
    EXPECT_NEAR(motion.acceleration.x, 1.0, 1e-3);
  }
}

TEST(AdaptiveWindow, EachAxisHasItsOwnWindow) {
  MotionFilter filter(kWindow, 1000.0);
  Motion motion;
  for (int i = 0; i < 100; ++i) {
    motion = filter.take({.time = i * kMillisecond, .position = {i % 2 * 0.001, 0.1 * i * 1e-3, 0.0}});
  }
  EXPECT_NEAR(std::abs(motion.velocity.x), 1.0, kRounding);  // 1 mm to and fro
  EXPECT_NEAR(motion.velocity.y, 0.1, kRounding);
}

TEST(AdaptiveWindow, UsesTheTimesOfTheSamples) {
  Track track(kWindow);
  for (int i = 0; i < 50; ++i) {
    track.time += i % 3 * kMillisecond;  // 1, 2 or 3 ms apart
    track.time += kMillisecond;
    const double velocity = track.tell(0.1 * static_cast<double>(track.time) * 1e-9).velocity.x;
    if (i > 0) {
      EXPECT_NEAR(velocity, 0.1, kRounding);
    }
  }
}

TEST(AdaptiveWindow, ASampleThatIsToldAgainCountsOnce) {
  Track once(kWindow);
  Track again(kWindow);
  for (int i = 0; i < 50; ++i) {
    const double x = 0.3 * std::sin(i * 0.05);
    const Motion first = once.at(x);
    again.at(x);
    for (int repeat = 0; repeat < 3; ++repeat) {
      const Motion same = again.tell(x);
      EXPECT_EQ(same.velocity, first.velocity);
      EXPECT_EQ(same.acceleration, first.acceleration);
    }
  }
}

// Packets that arrive together were not measured together: 0.3 mm in 20 us would be 15 m/s.
TEST(AdaptiveWindow, SamplesThatCameTogetherTellNoVelocity) {
  Track track(kWindow);
  for (int i = 0; i <= 50; ++i) track.at(0.3 * i * 1e-3);
  track.time += 20'000;
  EXPECT_NEAR(track.tell(0.3 * 51e-3).velocity.x, 0.6e-3 / 1.02e-3, kRounding)
      << "since the one before the last";
}

TEST(AdaptiveWindow, BeginsAnewAfterAGapAndWhenTimeGoesBack) {
  for (const Nanoseconds passed : {101 * kMillisecond, -kMillisecond}) {
    Track track(kWindow);
    for (int i = 0; i <= 50; ++i) track.at(0.3 * i * 1e-3);
    track.time += passed;
    const Motion motion = track.tell(1.0);
    EXPECT_EQ(motion.velocity.x, 0.0);
    EXPECT_EQ(motion.acceleration.x, 0.0);
    EXPECT_NEAR(track.at(1.0002).velocity.x, 0.2, kRounding);
  }
}

TEST(AdaptiveWindow, ASlowTrackerIsStillFollowed) {
  Track track(kWindow);
  for (int i = 0; i < 20; ++i) {
    track.time += 32 * kMillisecond;  // 30 in a second: further apart than the window
    const double velocity = track.at(0.1 * i * 33e-3).velocity.x;
    if (i > 0) {
      EXPECT_NEAR(velocity, 0.1, kRounding);
    }
  }
}

TEST(AdaptiveWindow, APositionThatIsNoNumberIsForgotten) {
  Track track(kWindow);
  for (int i = 0; i <= 50; ++i) track.at(0.3 * i * 1e-3);
  EXPECT_EQ(track.at(std::numeric_limits<double>::quiet_NaN()).velocity.x, 0.0);
  track.at(0.0);
  EXPECT_NEAR(track.at(0.0002).velocity.x, 0.2, kRounding);
}

// Backward Euler of dv/dt = (w - v) / T with T = 1 / (2 pi f): v_n = w (1 - (T / (T + dt))^n)
TEST(LowPass, ComesUpToASteadyMotionByItsCutOff) {
  Track track({.kind = MotionFilterKind::kLowPass, .cutoff = 40.0});
  const double lag = 1.0 / (2.0 * 3.14159265358979323846 * 40.0);
  track.at(0.0);
  for (int i = 1; i < 200; ++i) {
    const double expected = 0.5 * (1.0 - std::pow(lag / (lag + 1e-3), i));
    EXPECT_NEAR(track.at(0.5 * i * 1e-3).velocity.x, expected, kRounding);
  }
}

TEST(LowPass, TellsASteadyAccelerationInTheEnd) {
  Track track({.kind = MotionFilterKind::kLowPass, .cutoff = 40.0});
  Motion motion;
  for (int i = 0; i < 500; ++i) motion = track.at(0.5 * 2.0 * i * i * 1e-6);
  EXPECT_NEAR(motion.acceleration.x, 2.0, 1e-6);
}

TEST(DriverVelocity, IsPassedOnToTheBit) {
  MotionFilter filter({}, 1000.0);
  const Motion& motion = filter.take({.time = 5, .position = {1.0, 2.0, 3.0}, .velocity = {0.1, -0.2, 0.3}});
  EXPECT_EQ(motion.velocity, glm::dvec3(0.1, -0.2, 0.3));
  EXPECT_EQ(motion.acceleration, glm::dvec3(0.0));
}

TEST(MotionFilter, IsRealTimeSafeAtTheLongestWindowAndTheHighestRate) {
  MotionFilter filter({.kind = MotionFilterKind::kAdaptiveWindow, .window = 0.1, .noise = 0.01}, 8000.0);
  const rt::AllocationGuard watch;
  for (int i = 0; i < 5000; ++i) filter.take({.time = i * 125'000, .position = {i * 1e-6, 0.0, 0.0}});
}

}  // namespace
}  // namespace haptic::servo
