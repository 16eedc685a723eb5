#pragma once
// Forces that are to be drawn, and the same of a CSV file.

#include <array>
#include <limits>
#include <map>
#include <optional>
#include <string>

#include "client/plot/csv.h"

namespace haptic::plot {

/// Components in the world frame.
using Vector = std::array<double, 3>;

/// From the one up to before the other, in s.
struct Span {
  double from = -std::numeric_limits<double>::infinity();
  double to = std::numeric_limits<double>::infinity();
  bool has(double time) const noexcept { return time >= from && time < to; }
};

/// Forces in N at times in s. A finger's is the sum over its HIPs before the guard, a device's what the guard
/// let through, an object's what HIPs apply to it.
struct Forces {
  enum class Of { kFingers, kDevices, kObjects } of = Of::kFingers;
  std::map<std::string, std::map<double, Vector>> by_name{};
};

/// Forces in N of each HIP, by its number in its finger, at one time in s.
struct HipForces {
  double time = 0.0;
  std::map<std::string, std::map<double, Vector>> by_finger{};
};

/// Which of them the table has by its columns, as --hips-csv, --devices-csv and --objects-csv of `hapticd
/// simulate` do; objects if it is none of these.
Forces::Of first_of(const Csv& table);

/// Throws client::Invalid, with the file and its line or column, if the table does not have them.
Forces forces_of(const Csv& table, Forces::Of of, const Span& span = {});

/// At the last tick of --hips-csv that is not after `time` (s; none: the last of all). Throws as above.
HipForces hip_forces_of(const Csv& hips, std::optional<double> time);

}  // namespace haptic::plot
