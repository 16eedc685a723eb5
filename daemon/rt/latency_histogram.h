#pragma once
// Counts of durations in fixed bins, from 1 ns to about a second: linear below 16 ns, above it 16 bins to
// each power of two. A bin is never wider than 1/16 of where it begins, so a quantile is at most 6.25 % above
// the true one (and never below it); total, mean and max are exact. Durations beyond the last bin (1.07 s)
// are counted in it.
//
//     bin   0  1 .. 15 | 16 .. 31 | 32 .. 47 | 48 .. 63 | ...
//     ns    0  1 .. 15 | 16 .. 31 | 32 .. 63 | 64 .. 127| ...
//
// Trivially copyable. record() takes a few nanoseconds; everything here is real-time safe, nothing is
// synchronised.

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace haptic::rt {

class LatencyHistogram {
 public:
  static constexpr int kSubBits = 4;
  static constexpr std::uint64_t kSubBins = 1u << kSubBits;  // to each power of two
  static constexpr int kOctaves = 30 - kSubBits;             // 2^4 ns to 2^30 ns
  static constexpr std::size_t kBins = kSubBins * (kOctaves + 1);

  void record(std::uint64_t nanoseconds) noexcept {
    ++counts_[bin_of(nanoseconds)];
    ++total_;
    sum_ns_ += nanoseconds;
    max_ns_ = std::max(max_ns_, nanoseconds);
  }

  void clear() noexcept { *this = LatencyHistogram{}; }

  /// The bin that counts `nanoseconds`.
  static constexpr std::size_t bin_of(std::uint64_t nanoseconds) noexcept {
    if (nanoseconds < kSubBins) return static_cast<std::size_t>(nanoseconds);
    const int octave = static_cast<int>(std::bit_width(nanoseconds)) - 1 - kSubBits;
    if (octave >= kOctaves) return kBins - 1;
    const std::uint64_t within = (nanoseconds >> octave) - kSubBins;
    return static_cast<std::size_t>(kSubBins * static_cast<std::uint64_t>(octave + 1) + within);
  }

  /// The largest duration (ns) that bin `bin` is meant for.
  static constexpr std::uint64_t upper_ns(std::size_t bin) noexcept {
    if (bin < kSubBins) return bin;
    const std::size_t octave = bin / kSubBins - 1;
    return ((kSubBins + bin % kSubBins + 1) << octave) - 1;
  }

  std::uint64_t count(std::size_t bin) const noexcept { return counts_[bin]; }
  std::uint64_t total() const noexcept { return total_; }
  std::uint64_t max_ns() const noexcept { return max_ns_; }
  double mean_ns() const noexcept {
    return total_ == 0 ? 0.0 : static_cast<double>(sum_ns_) / static_cast<double>(total_);
  }

  /// A duration (ns) that the share `q` (0 to 1) of all do not exceed: the upper end of the bin of the
  /// ceil(q n)-th smallest, or the maximum if that is less. 0 if nothing was recorded.
  std::uint64_t quantile_ns(double q) const noexcept {
    if (total_ == 0) return 0;
    const double rank = std::ceil(std::clamp(q, 0.0, 1.0) * static_cast<double>(total_));
    const auto wanted = std::max<std::uint64_t>(1, static_cast<std::uint64_t>(rank));
    std::uint64_t seen = 0;
    for (std::size_t bin = 0; bin + 1 < kBins; ++bin) {
      seen += counts_[bin];
      if (seen >= wanted) return std::min(upper_ns(bin), max_ns_);
    }
    return max_ns_;
  }

 private:
  std::array<std::uint64_t, kBins> counts_{};
  std::uint64_t total_ = 0;
  std::uint64_t sum_ns_ = 0;  // wraps after 584 years
  std::uint64_t max_ns_ = 0;
};

}  // namespace haptic::rt
