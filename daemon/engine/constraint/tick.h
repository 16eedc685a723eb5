#pragma once
// What the handlers of the five states share. Each handler makes one transition of one proxy and is one file
// of this folder. It returns true if the proxy is known to stay where it then is, so that the iteration that
// would find out can be left away. Points are in the object frame. Servo thread; real-time safe.

#include <span>

#include "engine/cell_complex.h"
#include "engine/material.h"
#include "engine/motion.h"
#include "engine/proxy.h"

namespace haptic::engine {

/// What lies beyond the hull.
inline constexpr Material kVoid{};

/// One proxy in one tick.
struct Tick {
  const CellComplex& complex;
  std::span<const Material> materials;
  Pull pull;

  double eps() const noexcept { return pull.tolerance; }
  const glm::dvec3& p() const noexcept { return pull.hip; }
  const Material& material(Index cell) const noexcept {
    return cell == kNone ? kVoid : materials[complex.cells()[cell].region];
  }
  /// Whether a proxy at q would move toward the HIP inside this cell.
  bool admits(const glm::dvec3& q, Index cell) const noexcept {
    return move(pull, q, p(), material(cell)).moves;
  }
};

inline void enter(Proxy& proxy, ConstraintState state, Index cell, Index feature) noexcept {
  proxy.state = state;
  proxy.cell = cell;
  proxy.feature = feature;
}

inline Index other_cell(const Face& face, Index cell) noexcept {
  return face.cells[0] == cell ? face.cells[1] : face.cells[0];
}

/// A motion from a point with signed distance `before` to one with `after` < 0 leaves the side after this
/// fraction.
inline double crossing(double before, double after) noexcept {
  const double from = before > 0.0 ? before : 0.0;
  return from / (from - after);
}

/// One transition from whatever state the proxy is in.
bool step(Tick& tick, Proxy& proxy) noexcept;

/// Inside a cell: toward the HIP, or to the face through which that motion leaves (paper 2.2 (1)).
bool step_tet(Tick& tick, Proxy& proxy) noexcept;
/// On a face: into one of its cells, out of the hull, or along the face (paper 2.2 (2)).
bool step_sur(Tick& tick, Proxy& proxy) noexcept;
/// On an edge: into a cell around it, out of the hull, along a face, along the edge (paper 2.2 (3)).
bool step_edg(Tick& tick, Proxy& proxy) noexcept;
/// On a vertex: into a cell around it, out of the hull, along a face or an edge (paper 2.2 (4)).
bool step_ver(Tick& tick, Proxy& proxy) noexcept;
/// Outside: after the HIP, until its path enters the hull (paper 2.2 (5)).
bool step_out(Tick& tick, Proxy& proxy) noexcept;

}  // namespace haptic::engine
