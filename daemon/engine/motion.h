#pragma once
// The motion function (paper section 2.3, equations 1, 3 and 4; viscous drag added), one family for all
// materials.
//
// A proxy at q that is drawn toward its goal c (the HIP p itself inside a cell, the foot of p on a face or an
// edge) follows it, but stays behind by the lag
//
//      c ------ lag ------ q' <-------------- q        lag = F/k + mu |p - c|
//
// F is the yield force of the material that is moved in; mu is the Coulomb coefficient of the material that
// holds the proxy: static until the proxy moved in the last tick, kinetic from then on. A viscous material
// lets q approach the lag only with the time constant drag/k. Points in the object frame. Pure; real-time
// safe.

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "engine/material.h"

namespace haptic::engine {

/// How one HIP draws its proxy during one tick.
struct Pull {
  glm::dvec3 hip;    // p, m
  double stiffness;  // k, N/m
  double tolerance;  // m; shorter motions are none
  double time_left;  // s of this tick that viscous motion has not used
  bool slipping;     // the proxy moved in the last tick
};

/// Where the motion function takes the proxy, if anywhere.
struct Motion {
  bool moves = false;
  glm::dvec3 to{0.0, 0.0, 0.0};
};

/// How far friction against `held_by` keeps the proxy from a goal that is `distance` from the HIP (m): |f_t|
/// <= mu |f_n|.
inline double friction_lag(const Pull& pull, const Material& held_by, double distance) noexcept {
  return (pull.slipping ? held_by.kinetic_friction : held_by.static_friction) * distance;
}

/// The motion from q toward `goal` inside the material `in`, against a lag by friction (m).
inline Motion move(const Pull& pull, const glm::dvec3& q, const glm::dvec3& goal, const Material& in,
                   double lag_by_friction = 0.0) noexcept {
  if (is_rigid(in)) return {};
  const double lag = in.yield_force / pull.stiffness + lag_by_friction;
  const glm::dvec3 back = q - goal;
  const double squared = glm::dot(back, back);
  if (lag == 0.0 && in.drag == 0.0) return {squared > pull.tolerance * pull.tolerance, goal};

  const double distance = std::sqrt(squared);
  if (distance <= lag + pull.tolerance) return {};
  const double rest =
      in.drag > 0.0 ? lag + (distance - lag) * std::exp(-pull.stiffness * pull.time_left / in.drag) : lag;
  if (distance - rest <= pull.tolerance) return {};
  return {true, goal + (rest / distance) * back};
}

/// Takes from the tick the time that a viscous motion from q toward `goal` used: all that was left if it went
/// its whole way, else the time after which it was at `stop`.
inline void spend_time(Pull& pull, const glm::dvec3& q, const glm::dvec3& goal, const Material& in,
                       double lag_by_friction, const glm::dvec3* stop) noexcept {
  if (in.drag <= 0.0) return;
  double used = pull.time_left;
  if (stop != nullptr) {
    const double lag = in.yield_force / pull.stiffness + lag_by_friction;
    const double before = glm::distance(q, goal) - lag;
    const double after = glm::distance(*stop, goal) - lag;
    if (after > 0.0) used = std::min(used, in.drag / pull.stiffness * std::log(before / after));
  }
  pull.time_left = std::max(0.0, pull.time_left - used);
}

}  // namespace haptic::engine
