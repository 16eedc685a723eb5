#include "engine/constraint/ways.h"

namespace haptic::engine {
namespace {

/// Whether a path that touches the hull at q, on the rim of this face, goes on into a cell around the edge or
/// vertex that is touched. A path that only touches there stays outside.
bool enters_at_rim(const Tick& tick, const glm::dvec3& q, Index face_index) noexcept {
  const FaceRim& rim = tick.complex.rims()[face_index];
  const double reach = 10.0 * tick.eps();
  bool on_edge[3];
  int edges = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    on_edge[i] = rim.inward[i].side(q) <= reach;
    edges += on_edge[i] ? 1 : 0;
  }
  if (edges == 0) return true;
  Proxy at_rim;
  at_rim.position = q;
  if (edges == 1) {
    const std::size_t i = on_edge[0] ? 0 : (on_edge[1] ? 1 : 2);
    enter(at_rim, ConstraintState::kEdg, kNone, rim.edges[i]);
  } else {
    const std::size_t shared = on_edge[0] && on_edge[1] ? 1 : (on_edge[1] && on_edge[2] ? 2 : 0);
    enter(at_rim, ConstraintState::kVer, kNone, rim.vertices[shared]);
  }
  return cells_facing_hip(tick, at_rim).first != kNone;
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
    if (t * glm::length(path) <= 10.0 * tick.eps() && !enters_at_rim(tick, q, index)) return;
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
