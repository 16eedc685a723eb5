#include "service/heartbeat_watch.h"

#include <gtest/gtest.h>

namespace haptic::service {
namespace {

using Verdict = HeartbeatWatch::Verdict;

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kWatchdog = 2000 * kMs;

// looks every 2 ms from `from_ms` until `to_ms` at a servo thread of so many ticks a second; counts a verdict
int count(HeartbeatWatch& watch, Verdict verdict, std::int64_t from_ms, std::int64_t to_ms, double hz) {
  int found = 0;
  for (std::int64_t ms = from_ms; ms < to_ms; ms += 2) {
    const auto ticks = static_cast<std::uint64_t>(hz * 1e-3 * static_cast<double>(ms));
    if (watch.look(ms * kMs, ticks) == verdict) ++found;
  }
  return found;
}

TEST(HeartbeatWatch, CallsTheDaemonReadyOnceWhenTicksKeepTheirPeriod) {
  HeartbeatWatch watch(1000.0, std::nullopt);
  // the first window ends 200 ms after the first look
  EXPECT_EQ(count(watch, Verdict::kReady, 0, 200, 1000.0), 0);
  EXPECT_EQ(count(watch, Verdict::kReady, 200, 202, 1000.0), 1);
  EXPECT_EQ(count(watch, Verdict::kReady, 202, 5000, 1000.0), 0);
  EXPECT_DOUBLE_EQ(watch.measured_hz(), 1000.0);
}

TEST(HeartbeatWatch, NeverCallsAThreadReadyThatLosesMoreThanATenthOfItsTicks) {
  HeartbeatWatch slow(1000.0, std::nullopt);
  EXPECT_EQ(count(slow, Verdict::kReady, 0, 5000, 890.0), 0);
  HeartbeatWatch nearly(1000.0, std::nullopt);
  EXPECT_EQ(count(nearly, Verdict::kReady, 0, 5000, 910.0), 1);
}

TEST(HeartbeatWatch, WaitsForAThreadThatFindsItsPeriodLate) {
  HeartbeatWatch watch(1000.0, std::nullopt);
  EXPECT_EQ(count(watch, Verdict::kReady, 0, 1000, 0.0), 0);
  EXPECT_EQ(count(watch, Verdict::kReady, 1000, 2000, 1000.0), 1);
}

TEST(HeartbeatWatch, SaysNothingToAWatchdogBeforeTheProof) {
  HeartbeatWatch watch(1000.0, kWatchdog);
  EXPECT_EQ(count(watch, Verdict::kAlive, 0, 5000, 500.0), 0);
}

TEST(HeartbeatWatch, TellsTheWatchdogFourTimesInItsLimit) {
  HeartbeatWatch watch(1000.0, kWatchdog);
  count(watch, Verdict::kReady, 0, 202, 1000.0);
  // a word each 500 ms after the proof at 200 ms: at 700, 1200, ... 10200
  EXPECT_EQ(count(watch, Verdict::kAlive, 202, 10'202, 1000.0), 20);
}

TEST(HeartbeatWatch, FallsSilentWhileTheHeartbeatStandsStill) {
  HeartbeatWatch watch(1000.0, kWatchdog);
  count(watch, Verdict::kReady, 0, 202, 1000.0);
  for (std::int64_t ms = 202; ms < 10'000; ms += 2) {
    ASSERT_EQ(watch.look(ms * kMs, 200), Verdict::kNothing) << ms;
  }
  EXPECT_EQ(watch.look(10'000 * kMs, 201), Verdict::kAlive);
}

TEST(HeartbeatWatch, TellsNobodyThatItLivesIfNobodyWatches) {
  HeartbeatWatch watch(1000.0, std::nullopt);
  EXPECT_EQ(count(watch, Verdict::kAlive, 0, 10'000, 1000.0), 0);
}

TEST(HeartbeatWatch, MeasuresTheSlowestRateOverTwentyTicks) {
  HeartbeatWatch watch(100.0, std::nullopt);
  EXPECT_EQ(count(watch, Verdict::kReady, 0, 250, 100.0), 1);
}

}  // namespace
}  // namespace haptic::service
