#pragma once
// Materials: the numbers from which motion.h makes the paper's motion functions (section 2.3).

#include <limits>

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
