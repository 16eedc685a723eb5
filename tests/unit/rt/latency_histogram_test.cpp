#include "rt/latency_histogram.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <type_traits>
#include <vector>

namespace haptic::rt {
namespace {

static_assert(std::is_trivially_copyable_v<LatencyHistogram>);

TEST(LatencyHistogram, BinsFollowEachOtherWithoutGaps) {
  for (std::size_t bin = 0; bin + 1 < LatencyHistogram::kBins; ++bin) {
    const std::uint64_t upper = LatencyHistogram::upper_ns(bin);
    EXPECT_EQ(LatencyHistogram::bin_of(upper), bin);
    EXPECT_EQ(LatencyHistogram::bin_of(upper + 1), bin + 1);
  }
}

TEST(LatencyHistogram, NoBinIsWiderThanASixteenthOfWhereItBegins) {
  for (std::size_t bin = 1; bin < LatencyHistogram::kBins; ++bin) {
    const std::uint64_t begin = LatencyHistogram::upper_ns(bin - 1) + 1;
    const std::uint64_t width = LatencyHistogram::upper_ns(bin) + 1 - begin;
    EXPECT_LE((width - 1) * 16, begin) << "bin " << bin;
  }
}

TEST(LatencyHistogram, ReachesOneSecond) {
  EXPECT_GE(LatencyHistogram::upper_ns(LatencyHistogram::kBins - 1), 1'000'000'000u);
}

TEST(LatencyHistogram, CountsWhatIsBeyondTheLastBinInIt) {
  LatencyHistogram histogram;
  histogram.record(std::uint64_t{1} << 30);
  histogram.record(~std::uint64_t{0} >> 1);
  EXPECT_EQ(histogram.count(LatencyHistogram::kBins - 1), 2u);
  EXPECT_EQ(histogram.quantile_ns(1.0), ~std::uint64_t{0} >> 1);
}

TEST(LatencyHistogram, KeepsTotalMeanAndMaximumExactly) {
  LatencyHistogram histogram;
  for (const std::uint64_t value : {1000u, 2000u, 4001u}) histogram.record(value);
  EXPECT_EQ(histogram.total(), 3u);
  EXPECT_EQ(histogram.max_ns(), 4001u);
  EXPECT_DOUBLE_EQ(histogram.mean_ns(), 7001.0 / 3.0);
}

TEST(LatencyHistogram, AnEmptyOneSaysZero) {
  const LatencyHistogram histogram;
  EXPECT_EQ(histogram.quantile_ns(0.99), 0u);
  EXPECT_EQ(histogram.mean_ns(), 0.0);
}

TEST(LatencyHistogram, ForgetsEverythingWhenCleared) {
  LatencyHistogram histogram;
  histogram.record(5);
  histogram.clear();
  EXPECT_EQ(histogram.total(), 0u);
  EXPECT_EQ(histogram.max_ns(), 0u);
  EXPECT_EQ(histogram.count(5), 0u);
}

// The true quantile is found by sorting; the histogram's may be above it by the width of a bin and never
// below.
TEST(LatencyHistogram, QuantilesAreNeverBelowTheTrueOnesAndAtMostASixteenthAbove) {
  std::mt19937_64 random(1);
  std::lognormal_distribution<double> latency(std::log(20e3), 1.5);
  LatencyHistogram histogram;
  std::vector<std::uint64_t> values;
  for (int i = 0; i < 10000; ++i) {
    values.push_back(static_cast<std::uint64_t>(latency(random)));
    histogram.record(values.back());
  }
  std::sort(values.begin(), values.end());
  for (const double q : {0.0, 0.01, 0.5, 0.9, 0.99, 0.999, 1.0}) {
    const double rank = std::max(1.0, std::ceil(q * static_cast<double>(values.size())));
    const auto exact = static_cast<double>(values[static_cast<std::size_t>(rank) - 1]);
    const auto told = static_cast<double>(histogram.quantile_ns(q));
    EXPECT_GE(told, exact) << "q " << q;
    EXPECT_LE(told, exact * (1.0 + 1.0 / 16.0)) << "q " << q;
  }
}

}  // namespace
}  // namespace haptic::rt
