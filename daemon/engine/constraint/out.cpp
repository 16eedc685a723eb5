#include "engine/constants.h"
#include "engine/constraint/ways.h"

namespace haptic::engine {
namespace {

/// Whether some cell around the edge or vertex that a point is on contains the direction to the HIP.
bool is_entered(const Tick& tick, ConstraintState state, Index feature) noexcept {
  Proxy at_feature;
  enter(at_feature, state, kNone, feature);
  return cells_facing_hip(tick, at_feature).first != kNone;
}

/// Whether a path that touches the hull at q, on the rim of this face, goes on into the complex. A path that
/// only touches there stays outside; so every edge and vertex that q could as well be on must agree.
bool enters_at_rim(const Tick& tick, const glm::dvec3& q, Index face_index) noexcept {
  const FaceRim& rim = tick.complex.rims()[face_index];
  for (std::size_t i = 0; i < 3; ++i) {
    const bool on_edge = rim.inward[i].side(q) <= kTouchReach * tick.eps();
    if (on_edge && !is_entered(tick, ConstraintState::kEdg, rim.edges[i])) return false;
    const bool on_vertex =
        glm::distance(tick.complex.vertices()[rim.vertices[i]], q) <= kTouchReach * tick.eps();
    if (on_vertex && !is_entered(tick, ConstraintState::kVer, rim.vertices[i])) return false;
  }
  return true;
}

}  // namespace

bool step_out(Tick& tick, Proxy& proxy) noexcept {
  const glm::dvec3 q = proxy.position;
  const glm::dvec3 path = tick.p() - q;
  Box swept;
  swept.add(q);
  swept.add(tick.p());
  swept.low -= tick.eps();
  swept.high += tick.eps();

  double first = 2.0;
  Index hit = kNone;
  tick.complex.boundary_tree().visit_overlaps(swept, [&](std::uint32_t item) {
    const Index index = tick.complex.hull_faces()[item];
    const Face& face = tick.complex.faces()[index];
    const double before = face.plane.side(q);
    const double after = face.plane.side(tick.p());
    if (before > tick.eps() || after <= tick.eps()) return;
    const double t = before >= 0.0 ? 0.0 : before / (before - after);
    if (t > first || (t == first && index > hit)) return;
    const glm::dvec3 x = q + t * path;
    const FaceRim& rim = tick.complex.rims()[index];
    for (const Plane& edge : rim.inward) {
      if (edge.side(x) < -tick.eps()) return;
    }
    if (t * glm::length(path) <= kTouchReach * tick.eps() && !enters_at_rim(tick, q, index)) return;
    first = t;
    hit = index;
  });
  if (hit == kNone) {
    proxy.position = tick.p();
    return true;
  }
  proxy.position = q + first * path;
  enter(proxy, ConstraintState::kSur, tick.complex.faces()[hit].cells[0], hit);
  return false;
}

}  // namespace haptic::engine
