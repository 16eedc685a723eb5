#pragma once
// Pictures of forces, and of what the daemon counts.

#include <string>

#include "client/plot/forces.h"
#include "client/plot/picture.h"
#include "haptic/v1/telemetry.pb.h"

namespace haptic::plot {

/// |F| in N over time in s.
Picture force(const Forces& forces);

/// |F_t| / |F_n| over time for each finger, the normal being a unit vector in the world frame. There is no
/// point where |F_n| < 1e-9 N.
Picture friction(const Forces& fingers, const Vector& normal);

/// |F| in N of each HIP, over the HIP's number in its finger.
Picture hips(const HipForces& forces);

/// Mean time in ns of each transition of the constraint that was timed.
Picture transitions(const v1::Stats& stats);

/// The share of ticks that took longer than a time, for the lateness of the servo thread and each stage of
/// the tick.
Picture latency(const v1::Stats& stats);

/// Reads what `hapticctl --json stats` printed. Throws client::Invalid.
v1::Stats read_stats(const std::string& path);

}  // namespace haptic::plot
