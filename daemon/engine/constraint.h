#pragma once
// The state machine of the paper (section 2.2), with the corrections that README.md in this folder lists: one
// HIP, one object, one tick. A HIP that is still during the tick draws its proxy along the projected gradient
// flow of |p - q|^2/2 inside the permitted region: straight inside a cell, along a face, along an edge, until
// nothing more can move.
//
//       Tet <---> Sur <---> Edg ---> Ver        Sur, Edg, Ver ---> Out when the HIP has left the hull
//        ^         ^         ^        |         Out ---> Sur when its path enters it
//        +---------+---------+--------+
//
// Frame: the object's, in which both HIP and proxy are given.

#include <array>
#include <cstdint>
#include <span>

#include "engine/cell_complex.h"
#include "engine/material.h"
#include "engine/proxy.h"

namespace haptic::engine {

/// Reads a clock in nanoseconds. The engine has none of its own: who wants the time of each transition lends
/// one. It must be real-time safe.
using Clock = std::uint64_t (*)() noexcept;

/// Counts of every (before, after) pair, and the time of those that were timed: the paper's Tables 1 and 2.
struct TransitionTable {
  using Table = std::array<std::array<std::uint64_t, kConstraintStates>, kConstraintStates>;
  Table count{};                  // [before][after]
  Table timed{};                  // how many of them were timed
  Table nanoseconds{};            // what these took together
  std::uint64_t limited = 0;      // ticks of one proxy that met kTransitionLimit
  std::uint64_t relocations = 0;  // circles broken
};

/// Whether Table 1 permits the transition; with Edg -> Ver, which the paper's text needs and its table lacks.
bool is_permitted(ConstraintState before, ConstraintState after) noexcept;

/// What a HIP is constrained by: an object's cells and the material of each of its regions.
struct ConstraintModel {
  const CellComplex& cells;
  std::span<const Material> materials;  // by Cell::region
};

/// Puts the proxy at the HIP without a path, as at the start of a scene. A HIP inside rigid material is
/// swallowed: its proxy stays with it and gives no force until it has left. Real-time safe.
void start_proxy(const ConstraintModel& model, const glm::dvec3& hip, Proxy& proxy) noexcept;

/// Moves the proxy for one tick: `hip` is where the HIP is now (m, object frame), `stiffness` its k (N/m),
/// `dt` the tick (s). |hip - proxy| never grows. Counts each transition in `table`, and times them if a clock
/// is given. Real-time safe.
void constrain(const ConstraintModel& model, const glm::dvec3& hip, double stiffness, double dt, Proxy& proxy,
               TransitionTable& table, Clock clock = nullptr) noexcept;

}  // namespace haptic::engine
