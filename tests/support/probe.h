#pragma once
// One HIP in one object, without a world around it: what the constraint tests drag about.

#include <glm/geometric.hpp>
#include <utility>
#include <vector>

#include "engine/constraint.h"

namespace haptic::test {

inline engine::Material air() { return {}; }
inline engine::Material rigid(double static_friction = 0.0, double kinetic_friction = 0.0) {
  return {engine::kRigid, 0.0, static_friction, kinetic_friction, 1000.0};
}
inline engine::Material yielding(double force, double drag = 0.0) { return {force, drag, 0.0, 0.0, 1000.0}; }
inline engine::Material viscous(double drag) { return {0.0, drag, 0.0, 0.0, 1000.0}; }

/// A tick is 1 ms, the stiffness 100 N/m unless told.
class Probe {
 public:
  /// `materials` by region: for the shapes with air, the outside first, then the inside.
  Probe(engine::CellComplex complex, std::vector<engine::Material> materials, const glm::dvec3& start,
        double stiffness = 100.0)
      : complex_(std::move(complex)), materials_(std::move(materials)), stiffness_(stiffness) {
    start_at(start);
  }

  void start_at(const glm::dvec3& hip) {
    hip_ = hip;
    engine::start_proxy(model(), hip, proxy_);
  }

  /// One tick in which the HIP is at `hip`; returns where the proxy is then.
  const glm::dvec3& move_to(const glm::dvec3& hip) {
    hip_ = hip;
    engine::constrain(model(), hip, stiffness_, 1e-3, proxy_, table_);
    return proxy_.position;
  }

  /// The same over `ticks` equal steps along a straight line.
  const glm::dvec3& drag_to(const glm::dvec3& hip, int ticks) {
    const glm::dvec3 from = hip_;
    for (int i = 1; i <= ticks; ++i) move_to(from + (hip - from) * (static_cast<double>(i) / ticks));
    return proxy_.position;
  }

  /// On the user, N.
  glm::dvec3 force() const { return stiffness_ * (proxy_.position - hip_); }

  const engine::CellComplex& complex() const { return complex_; }
  const std::vector<engine::Material>& materials() const { return materials_; }
  engine::ConstraintModel model() const { return {complex_, materials_}; }
  const glm::dvec3& hip() const { return hip_; }
  engine::Proxy& proxy() { return proxy_; }
  const engine::Proxy& proxy() const { return proxy_; }
  const engine::TransitionTable& table() const { return table_; }

 private:
  engine::CellComplex complex_;
  std::vector<engine::Material> materials_;
  double stiffness_;
  glm::dvec3 hip_{0.0, 0.0, 0.0};
  engine::Proxy proxy_;
  engine::TransitionTable table_;
};

}  // namespace haptic::test
