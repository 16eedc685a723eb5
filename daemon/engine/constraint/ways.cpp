#include "engine/constraint/ways.h"

namespace haptic::engine {
namespace {

/// Sorts one cell, whose planes through the feature `holds` tests, into `facing`.
template <class Holds>
void look_at(const Tick& tick, const Proxy& proxy, Index cell, Holds&& holds, Facing& facing) noexcept {
  const bool belonging = cell == proxy.cell;
  if (!belonging && facing.first != kNone && facing.admitting != kNone) return;
  if (!holds(tick.complex.cells()[cell])) return;
  if (belonging || facing.first == kNone) facing.first = cell;
  if ((belonging || facing.admitting == kNone) && tick.admits(proxy.position, cell)) facing.admitting = cell;
}

}  // namespace

Facing cells_facing_hip(const Tick& tick, const Proxy& proxy) noexcept {
  Facing facing;
  const glm::dvec3& p = tick.p();
  if (proxy.state == ConstraintState::kEdg) {
    for (const EdgeCell& around : tick.complex.cells_of_edge(proxy.feature)) {
      look_at(
          tick, proxy, around.cell,
          [&](const Cell& cell) {
            return cell.side(around.planes[0], p) >= -tick.eps() &&
                   cell.side(around.planes[1], p) >= -tick.eps();
          },
          facing);
    }
  } else {
    for (const Index index : tick.complex.cells_of_vertex(proxy.feature)) {
      look_at(
          tick, proxy, index,
          [&](const Cell& cell) {
            for (int i = 0; i < 4; ++i) {
              if (cell.vertices[static_cast<std::size_t>(i)] == proxy.feature) continue;
              if (cell.side(i, p) < -tick.eps()) return false;
            }
            return true;
          },
          facing);
    }
  }
  return facing;
}

const Material& most_permissive(const Tick& tick, Index edge) noexcept {
  const Material* best = nullptr;
  for (const Index face : tick.complex.faces_of_edge(edge)) {
    if (tick.complex.faces()[face].cells[1] == kNone) return kVoid;
  }
  for (const EdgeCell& around : tick.complex.cells_of_edge(edge)) {
    const Material& material = tick.material(around.cell);
    if (best == nullptr || material.yield_force < best->yield_force ||
        (material.yield_force == best->yield_force && material.drag < best->drag)) {
      best = &material;
    }
  }
  return best == nullptr ? kVoid : *best;
}

void consider(const Tick& tick, const glm::dvec3& q, const Candidate& candidate, Candidate& best) noexcept {
  if (candidate.distance2 <= best.distance2) return;
  if (move(tick.pull, q, candidate.goal, *candidate.in).moves) best = candidate;
}

void consider_face(const Tick& tick, const glm::dvec3& q, Index face_index, Candidate& best) noexcept {
  const Face& face = tick.complex.faces()[face_index];
  const double side = face.plane.side(tick.p());
  for (std::size_t i = 0; i < 2; ++i) {
    const Index kept_out_of = face.cells[i];
    const Index slides_in = face.cells[1 - i];
    const bool hip_is_there = (i == 0 ? side : -side) >= -tick.eps();
    if (!hip_is_there || kept_out_of == kNone || tick.admits(q, kept_out_of)) continue;
    Candidate candidate;
    candidate.goal = tick.p() - side * face.plane.normal;
    const glm::dvec3 way = candidate.goal - q;
    candidate.distance2 = glm::dot(way, way);
    candidate.state = ConstraintState::kSur;
    candidate.cell = slides_in == kNone ? kept_out_of : slides_in;
    candidate.feature = face_index;
    candidate.in = &tick.material(slides_in);
    candidate.held_by = &tick.material(kept_out_of);
    consider(tick, q, candidate, best);
  }
}

bool can_leave(const Tick& tick, const glm::dvec3& q, const Candidate& way) noexcept {
  const double lag = friction_lag(tick.pull, *way.held_by, glm::distance(tick.p(), way.goal));
  return move(tick.pull, q, way.goal, *way.in, lag).moves;
}

}  // namespace haptic::engine
