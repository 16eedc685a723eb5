#include "load/ranges.h"

#include <array>
#include <charconv>

namespace haptic::load {

std::string to_text(double value) {
  std::array<char, 32> buffer{};
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), result.ptr};
}

std::string to_text(const Range& range) {
  return "permitted: " +
         (range.above ? "more than " + to_text(range.low) + ", up to " : to_text(range.low) + " to ") +
         to_text(range.high) + range.unit;
}

void check_range(const TextSource& source, const std::string& field, double value, const Range& range) {
  const bool above = range.above ? value > range.low : value >= range.low;
  if (above && value <= range.high) return;
  source.fail(field, to_text(value) + " is out of range (" + to_text(range) + ")");
}

}  // namespace haptic::load
