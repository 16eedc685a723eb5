#pragma once
// Ways on from an edge or a vertex: the cells in whose direction the HIP lies, and the faces and edges along
// which the proxy could slide when none of those cells lets it in. Object frame; real-time safe.

#include "engine/constraint/tick.h"

namespace haptic::engine {

/// The cells around an edge or a vertex in whose direction the HIP lies.
struct Facing {
  Index first = kNone;      // the belonging cell if it is among them, else the first; kNone: there is none
  Index admitting = kNone;  // the first of them that lets the proxy move toward the HIP
};

/// For a proxy on an edge or a vertex.
Facing cells_facing_hip(const Tick& tick, const Proxy& proxy) noexcept;

/// The material of the fan around an edge in which a proxy moves most easily; the void if the edge is on the
/// hull.
const Material& most_permissive(const Tick& tick, Index edge) noexcept;

/// The face or edge along which a proxy on an edge or a vertex would go if there were no friction: the one on
/// which the foot of the HIP is furthest away, which is the steepest way down.
struct Candidate {
  double distance2 = -1.0;  // |goal - q|^2
  ConstraintState state = ConstraintState::kVer;
  Index cell = kNone;
  Index feature = kNone;
  glm::dvec3 goal{0.0, 0.0, 0.0};
  const Material* in = &kVoid;
  const Material* held_by = &kVoid;
};

/// Takes the candidate if it leads further than the best so far and the proxy could slide there without
/// friction.
void consider(const Tick& tick, const glm::dvec3& q, const Candidate& candidate, Candidate& best) noexcept;

/// The same for a face. It is a way if one of its cells keeps the HIP out and the other lets the proxy slide.
void consider_face(const Tick& tick, const glm::dvec3& q, Index face_index, Candidate& best) noexcept;

/// Whether friction lets the proxy go the way: it has its say only after the way is chosen.
bool can_leave(const Tick& tick, const glm::dvec3& q, const Candidate& way) noexcept;

/// Foot of the perpendicular from p on the line of the edge.
inline glm::dvec3 foot_on(const Edge& edge, const glm::dvec3& p) noexcept {
  return edge.origin + glm::dot(p - edge.origin, edge.direction) * edge.direction;
}

}  // namespace haptic::engine
