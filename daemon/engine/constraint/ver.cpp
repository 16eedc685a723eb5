#include "engine/constraint/ways.h"

namespace haptic::engine {

bool step_ver(Tick& tick, Proxy& proxy) noexcept {
  const Facing facing = cells_facing_hip(tick, proxy);
  if (facing.first == kNone) {
    enter(proxy, ConstraintState::kOut, kNone, kNone);
    return false;
  }
  if (facing.admitting != kNone) {
    enter(proxy, ConstraintState::kTet, facing.admitting, kNone);
    return false;
  }

  const Index vertex = proxy.feature;
  const glm::dvec3 q = proxy.position;
  Candidate way;
  for (const Index face : tick.complex.faces_of_vertex(vertex)) {
    const FaceRim& rim = tick.complex.rims()[face];
    const std::size_t i = rim.vertices[0] == vertex ? 0 : (rim.vertices[1] == vertex ? 1 : 2);
    const bool in_sector =
        rim.inward[i].side(tick.p()) > tick.eps() && rim.inward[(i + 2) % 3].side(tick.p()) > tick.eps();
    if (in_sector) consider_face(tick, q, face, way);
  }
  for (const Index index : tick.complex.edges_of_vertex(vertex)) {
    const Edge& edge = tick.complex.edges()[index];
    const double along = glm::dot(tick.p() - tick.complex.vertices()[vertex], edge.direction);
    if ((edge.ends[0] == vertex ? along : -along) <= tick.eps()) continue;
    Candidate candidate;
    candidate.goal = foot_on(edge, tick.p());
    const glm::dvec3 path = candidate.goal - q;
    candidate.distance2 = glm::dot(path, path);
    if (candidate.distance2 <= way.distance2) continue;
    candidate.state = ConstraintState::kEdg;
    candidate.cell = tick.complex.cells_of_edge(index).front().cell;
    candidate.feature = index;
    candidate.in = &most_permissive(tick, index);
    candidate.held_by = &tick.material(facing.first);
    consider(tick, q, candidate, way);
  }
  if (way.state == ConstraintState::kVer || !can_leave(tick, q, way)) return true;
  enter(proxy, way.state, way.cell, way.feature);
  return false;
}

}  // namespace haptic::engine
