#pragma once
// Makes the triangles of a PlaneMesh compact.

#include "engine/polygon.h"

namespace haptic::engine {

/// Flips edges until the triangles are as compact as their points permit (constrained Delaunay), then adds
/// points in the middle of long empty stretches (Ruppert's refinement), so that no point is the tip of very
/// many slim triangles. Edges between inside and outside stay as they are, and so does the rim of a mesh
/// without an outside; the rim of an outside may be divided.
void refine(PlaneMesh& mesh);

}  // namespace haptic::engine
