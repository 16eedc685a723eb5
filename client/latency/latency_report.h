#pragma once
// What was measured, for a terminal.

#include <string>

#include "client/latency/latency.h"

namespace haptic::latency {

/// One line for each bin from the first to the last that counted anything: its end, its count and a bar. The
/// bar is as long as the logarithm of the count, `width` characters for the largest: one late wake-up among a
/// million shows.
std::string draw(const Latenesses& times, std::size_t width);

/// "740 ns", "12.3 us", "1.20 ms"
std::string in_words(double nanoseconds);

}  // namespace haptic::latency
