#pragma once
// What there is to draw of what `hapticd simulate` and `hapticctl --json stats` write.

#include <array>
#include <optional>
#include <string>

#include "client/plot/csv.h"
#include "client/plot/picture.h"
#include "haptic/v1/telemetry.pb.h"

namespace haptic::plot {

// Each throws client::Invalid, with the file and its line or column, if the table is not of the kind it
// needs.

/// |F| in N over time in s: the sum over its HIPs for each finger (--hips-csv), what the guard let through
/// for each device (--devices-csv), or what HIPs apply to each object (--objects-csv).
Picture force(const Csv& table);

/// |F_t| / |F_n| over time for each finger of --hips-csv, F being the sum over its HIPs, and the normal a
/// unit vector in the world frame. There is no point where |F_n| < 1e-9 N.
Picture friction(const Csv& hips, const std::array<double, 3>& normal);

/// |F| in N of each HIP of --hips-csv, over the HIP's number in its finger, at the last tick that is not
/// after `time` (s; none: the last of all).
Picture hips(const Csv& hips, std::optional<double> time);

/// Mean time in ns of each transition of the constraint that was timed.
Picture transitions(const v1::Stats& stats);

/// The share of ticks that took longer than a time, for the lateness of the servo thread and each stage of
/// the tick.
Picture latency(const v1::Stats& stats);

/// Reads what `hapticctl --json stats` printed. Throws client::Invalid.
v1::Stats read_stats(const std::string& path);

}  // namespace haptic::plot
