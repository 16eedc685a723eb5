#pragma once
// Every tolerance of the engine: its value, its unit and the reason for it.

namespace haptic::engine {

/// The one length tolerance, as a fraction of the model's extent (diagonal of its bounding box). It is used
/// with the SAME value wherever a side, a rim or a rest is decided: two values that differ make endless loops
/// between them. 1e-11 is 1000 times the rounding of a coordinate and 1e-8 of a small cell.
inline constexpr double kLengthTolerance = 1e-11;

/// A cell whose smallest altitude is below this fraction of the extent is refused as flat: its planes would
/// not be known to kLengthTolerance.
inline constexpr double kFlatCell = 1e-8;

/// Extents (m) that a mesh may have. Far beyond what a hand can feel; inside them, no product of lengths
/// overflows or underflows.
inline constexpr double kSmallestExtent = 1e-9;
inline constexpr double kLargestExtent = 1e9;

/// How far a mesh may lie from the origin of its frame, as a multiple of its extent: there the rounding of a
/// coordinate (1.1e-16 of it) reaches kLengthTolerance.
inline constexpr double kFarthest = 1e5;

/// Transitions that one proxy may make in one tick. About two are needed for each boundary crossed; 20 m/s
/// through 1 mm cells needs 119. Beyond it the proxy stays where it is (always an admissible place) and the
/// tick is counted.
inline constexpr int kTransitionLimit = 4096;

/// Nearness, in length tolerances, at which a path from outside counts as touching an edge or a vertex where
/// it begins: a proxy that left the hull there may be a few tolerances beside the feature that it was on.
inline constexpr double kTouchReach = 10.0;

/// Nearness, in length tolerances, at which a proxy that goes round in a circle is put on a vertex or an
/// edge.
inline constexpr double kRelocationReach = 20.0;

/// How often a circle may be broken in one tick before the proxy is left where it is.
inline constexpr int kRelocationLimit = 3;

/// Coordinates of a finger beyond this (m) are a broken sample: even this far out, a double still resolves
/// 1e-10 m.
inline constexpr double kWorldReach = 1e6;

/// How far the squared norm of a device's quaternion may be from 1: wide for one sent in single precision,
/// narrow for anything that is no rotation.
inline constexpr double kUnitTolerance = 1e-3;

}  // namespace haptic::engine
