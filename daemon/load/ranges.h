#pragma once
// Permitted ranges of numbers, checked and told in one way.

#include <string>

#include "load/text_message.h"

namespace haptic::load {

/// From `low` to `high`; `above` leaves `low` itself out. `unit` is for the error: "m", or "".
struct Range {
  double low;
  double high;
  const char* unit = "";
  bool above = false;
};

/// No length in a file or message is larger (m): far beyond any model, far from overflow.
inline constexpr double kLargestLength = 1e6;
/// No size of a shape is smaller (m).
inline constexpr double kSmallestSize = 1e-6;

inline constexpr Range kSizes{kSmallestSize, kLargestLength, " m"};
inline constexpr Range kCoordinates{-kLargestLength, kLargestLength, " m"};

/// The shortest text that reads back as this number.
std::string to_text(double value);

/// "permitted: 0 to 5 N", "permitted: more than 0, up to 5 N".
std::string to_text(const Range& range);

/// Throws LoadError unless the value lies in the range.
void check_range(const TextSource& source, const std::string& field, double value, const Range& range);

}  // namespace haptic::load
