#include "client/latency/latency.h"

#include <gtest/gtest.h>

#include <numeric>

#include "client/latency/latency_report.h"

namespace haptic::latency {
namespace {

TEST(Latency, CountsLatenessesInBinsOfOneTwoFive) {
  Latenesses times;
  for (const std::uint64_t ns : {0U, 1'000U, 1'001U, 5'000U, 999'999U, 100'000'000U, 100'000'001U})
    times.record(ns);
  EXPECT_EQ(times.bins()[0], 2U) << "up to 1 us";
  EXPECT_EQ(times.bins()[1], 1U) << "up to 2 us";
  EXPECT_EQ(times.bins()[2], 1U) << "up to 5 us";
  EXPECT_EQ(times.bins()[9], 1U) << "up to 1 ms";
  EXPECT_EQ(times.bins()[15], 1U) << "up to 100 ms";
  EXPECT_EQ(times.bins()[16], 1U) << "beyond";
  EXPECT_EQ(times.min_ns(), 0U);
  EXPECT_EQ(times.histogram().max_ns(), 100'000'001U);
}

TEST(Latency, NothingMeasuredIsZeroEverywhere) {
  const Latenesses times;
  EXPECT_EQ(times.min_ns(), 0U);
  EXPECT_EQ(times.histogram().max_ns(), 0U);
  EXPECT_EQ(draw(times, 10), "");
}

// the bars are log(1 + count): of 99 twice that of 9
TEST(Latency, DrawsTheBinsBetweenTheFirstAndTheLastThatCounted) {
  Latenesses times;
  for (int i = 0; i < 99; ++i) times.record(3'000);
  for (int i = 0; i < 9; ++i) times.record(15'000);
  EXPECT_EQ(draw(times, 10),
            "<=   5 us        99  ##########\n"
            "<=  10 us         0\n"
            "<=  20 us         9  #####\n");
}

TEST(Latency, DrawsWhatIsBeyondAllBins) {
  Latenesses times;
  times.record(2'000'000'000);
  EXPECT_EQ(draw(times, 3), ">  100 ms         1  ###\n");
}

TEST(Latency, EveryPeriodIsAWakeUpOrMissed) {
  const Measured measured = measure(
      {.rate_hz = 1000.0, .duration = std::chrono::milliseconds(200), .thread = {}}, [] { return false; });
  const auto& bins = measured.times.bins();
  const std::uint64_t total = measured.times.histogram().total();
  EXPECT_GE(total + measured.missed, 200U);
  EXPECT_EQ(std::accumulate(bins.begin(), bins.end(), std::uint64_t{0}), total);
  EXPECT_LE(measured.times.min_ns(), measured.times.histogram().max_ns());
  EXPECT_GE(measured.seconds, 0.199);
}

TEST(Latency, EndsWhenItIsToldTo) {
  const Measured measured = measure({.duration = std::chrono::hours(1), .thread = {}}, [] { return true; });
  EXPECT_LE(measured.times.histogram().total(), 1U);
}

TEST(Latency, TellsWhatWasRefused) {
  const Measured measured = measure({.thread = {.cpu = 1023}}, [] { return true; });
  ASSERT_FALSE(measured.rights.warnings.empty());
  EXPECT_NE(measured.rights.warnings.back().find("CPU 1023"), std::string::npos);
}

}  // namespace
}  // namespace haptic::latency
