#pragma once
// What there is to draw in a recording. Times are s since its start, as for hapticctl export.
//
// Each function throws exporting::Missing if the recording has none of what it is asked for,
// recording::FormatError and recording::IoError.

#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "client/plot/forces.h"
#include "haptic/v1/telemetry.pb.h"
#include "proto/recording/recording.h"

namespace haptic::plot {

/// Whether the file begins as an MCAP file does; false if it cannot be read.
bool is_recording(const std::string& path);

/// The first that the recording has: of fingers, devices, objects.
Forces::Of first_of(const recording::Recording& recording);

/// By the times at which the daemon ticked; what was recorded within the span.
Forces forces_of(const recording::Recording& recording, Forces::Of of, const Span& span);

/// Of the last frame that was recorded not after `time` (s; none: the last of all).
HipForces hip_forces_of(const recording::Recording& recording, std::optional<double> time);

/// The last that were recorded within the span; they count from the daemon's start.
v1::Stats stats_of(const recording::Recording& recording, const Span& span);

}  // namespace haptic::plot
