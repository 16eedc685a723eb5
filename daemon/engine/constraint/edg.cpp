#include "engine/constraint/ways.h"

namespace haptic::engine {
namespace {

/// Along the edge, clipped at its ends; a proxy that stays at an end looks round the vertex.
void slide_on_edge(Tick& tick, Proxy& proxy, const Material& held_by) noexcept {
  const Edge& edge = tick.complex.edges()[proxy.feature];
  const glm::dvec3 q = proxy.position;
  const glm::dvec3 goal = foot_on(edge, tick.p());
  const Material& in = most_permissive(tick, proxy.feature);
  const double lag = friction_lag(tick.pull, held_by, glm::distance(tick.p(), goal));
  const Motion motion = move(tick.pull, q, goal, in, lag);

  // a motion may end at an end; a proxy that rests there looks round the vertex
  const double along = glm::dot((motion.moves ? motion.to : q) - edge.origin, edge.direction);
  const double margin = motion.moves ? -tick.eps() : tick.eps();
  const bool at_start = along <= margin;
  if (at_start || along >= edge.length - margin) {
    const Index end = edge.ends[at_start ? 0 : 1];
    const glm::dvec3 vertex = tick.complex.vertices()[end];
    if (motion.moves) {
      spend_time(tick.pull, q, goal, in, lag, &vertex);
      proxy.position = vertex;
    }
    enter(proxy, ConstraintState::kVer, proxy.cell, end);
    return;
  }
  if (motion.moves) {
    proxy.position = motion.to;
    spend_time(tick.pull, q, goal, in, lag, nullptr);
  }
}

}  // namespace

bool step_edg(Tick& tick, Proxy& proxy) noexcept {
  const Facing facing = cells_facing_hip(tick, proxy);
  if (facing.first == kNone) {
    enter(proxy, ConstraintState::kOut, kNone, kNone);
    return false;
  }
  if (facing.admitting != kNone) {
    enter(proxy, ConstraintState::kTet, facing.admitting, kNone);
    return false;
  }

  const glm::dvec3 q = proxy.position;
  Candidate way;
  for (const Index face : tick.complex.faces_of_edge(proxy.feature)) {
    const FaceRim& rim = tick.complex.rims()[face];
    const std::size_t i = rim.edges[0] == proxy.feature ? 0 : (rim.edges[1] == proxy.feature ? 1 : 2);
    if (rim.inward[i].side(tick.p()) > tick.eps()) consider_face(tick, q, face, way);
  }
  if (way.state == ConstraintState::kSur) {
    if (can_leave(tick, q, way)) {
      enter(proxy, ConstraintState::kSur, way.cell, way.feature);
      return false;
    }
    const Edge& edge = tick.complex.edges()[proxy.feature];
    const double along = glm::dot(q - edge.origin, edge.direction);
    if (along <= tick.eps())
      enter(proxy, ConstraintState::kVer, proxy.cell, edge.ends[0]);
    else if (along >= edge.length - tick.eps())
      enter(proxy, ConstraintState::kVer, proxy.cell, edge.ends[1]);
    return false;
  }
  slide_on_edge(tick, proxy, tick.material(facing.first));
  return false;
}

}  // namespace haptic::engine
