#pragma once
// Materials: what the paper calls motion functions (section 2.3, equations 1, 3 and 4), as one family.
//
// A proxy at q that is drawn toward its goal c (the HIP p itself inside a cell, the foot of p on a face or an
// edge) follows it, but stays behind by a threshold distance s*:
//
//      c ----- s* ----- q' <-------------- q        s* = F/k + mu |p - c|
//
// F is the yield force of the material that is moved in, mu the Coulomb coefficient of the material that is
// touched: static until the proxy moved in the last tick, kinetic from then on. A viscous material lets q
// approach the threshold only with time constant drag/k. Everything here is pure and real-time safe.

#include <cmath>
#include <limits>

#include "engine/pose.h"

namespace haptic::engine {

inline constexpr double kRigid = std::numeric_limits<double>::infinity();

/// The material of a cell.
struct Material {
  double yield_force = 0.0;       // N; 0: free motion, kRigid: no motion inside
  double drag = 0.0;              // N s/m of one HIP moving inside
  double static_friction = 0.0;   // Coulomb mu_s on its surface
  double kinetic_friction = 0.0;  // Coulomb mu_k on its surface
  double density = 0.0;           // kg/m^3, for the body that it makes
};

inline bool is_rigid(const Material& material) noexcept { return material.yield_force == kRigid; }

}  // namespace haptic::engine
