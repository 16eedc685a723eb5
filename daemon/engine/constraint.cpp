#include "engine/constraint.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "engine/constants.h"
#include "engine/motion.h"

namespace haptic::engine {
namespace {

using State = ConstraintState;

/// What lies beyond the hull.
constexpr Material kVoid{};

/// One proxy in one tick.
struct Tick {
  const CellComplex& complex;
  std::span<const Material> materials;
  Pull pull;

  double eps() const noexcept { return pull.tolerance; }
  const glm::dvec3& p() const noexcept { return pull.hip; }
  const Material& material(Index cell) const noexcept {
    return cell == kNone ? kVoid : materials[complex.cells()[cell].region];
  }
  /// Whether a proxy at q would move toward the HIP inside this cell.
  bool admits(const glm::dvec3& q, Index cell) const noexcept {
    return move(pull, q, p(), material(cell)).moves;
  }
};

void enter(Proxy& proxy, State state, Index cell, Index feature) noexcept {
  proxy.state = state;
  proxy.cell = cell;
  proxy.feature = feature;
}

Index other_cell(const Face& face, Index cell) noexcept {
  return face.cells[0] == cell ? face.cells[1] : face.cells[0];
}

/// A motion from a point with signed distance `before` to one with `after` < 0 leaves the side after this
/// fraction.
double crossing(double before, double after) noexcept {
  const double from = std::fmax(0.0, before);
  return from / (from - after);
}

// Each handler makes one transition. It returns true if the proxy is known to stay where it then is, so that
// the iteration that would find out can be left away.

// (1) Inside a cell: move toward the HIP, or to the face through which the motion leaves.
bool step_tet(Tick& tick, Proxy& proxy) noexcept {
  const Cell& cell = tick.complex.cells()[proxy.cell];
  const Material& material = tick.materials[cell.region];
  const glm::dvec3 q = proxy.position;
  const Motion motion = move(tick.pull, q, tick.p(), material);
  if (!motion.moves) return true;

  double first = 2.0;
  double deepest = 0.0;
  int exit = -1;
  for (int i = 0; i < 4; ++i) {
    const double after = cell.side(i, motion.to);
    if (after >= -tick.eps()) continue;
    const double t = crossing(cell.side(i, q), after);
    if (t < first || (t == first && after < deepest)) {
      first = t;
      deepest = after;
      exit = i;
    }
  }
  if (exit < 0) {
    proxy.position = motion.to;
    spend_time(tick.pull, q, tick.p(), material, 0.0, nullptr);
    return true;
  }
  proxy.position = q + first * (motion.to - q);
  spend_time(tick.pull, q, tick.p(), material, 0.0, &proxy.position);
  enter(proxy, State::kSur, proxy.cell, cell.faces[static_cast<std::size_t>(exit)]);
  return false;
}

/// The slide of a proxy on a face toward the foot of the HIP, in the side of it that lets it go further.
struct Slide {
  Motion motion;
  glm::dvec3 goal;
  const Material* in = &kVoid;
  double lag = 0.0;
};

Slide slide_on_face(const Tick& tick, const glm::dvec3& q, const Plane& plane, double side, Index cell,
                    Index neighbour) noexcept {
  Slide slide;
  slide.goal = tick.p() - side * plane.normal;
  const Material* const sides[2] = {&tick.material(cell), &tick.material(neighbour)};
  double furthest = -1.0;
  for (int i = 0; i < 2; ++i) {
    const Material& in = *sides[i];
    if (is_rigid(in)) continue;
    const double lag = friction_lag(tick.pull, *sides[1 - i], std::abs(side));
    const Motion motion = move(tick.pull, q, slide.goal, in, lag);
    if (!motion.moves) continue;
    const glm::dvec3 way = motion.to - q;
    const double length = glm::dot(way, way);
    if (length > furthest) {
      furthest = length;
      slide.motion = motion;
      slide.in = &in;
      slide.lag = lag;
    }
  }
  return slide;
}

// (2) On a face: into one of its cells, out of the hull, or along the face.
bool step_sur(Tick& tick, Proxy& proxy) noexcept {
  const Index face_index = proxy.feature;
  const Face& face = tick.complex.faces()[face_index];
  const glm::dvec3 q = proxy.position;
  const double side = face.plane.side(tick.p());  // positive toward cells[0]
  const double inward = face.cells[0] == proxy.cell ? side : -side;
  const Index neighbour = other_cell(face, proxy.cell);

  if (inward > tick.eps() && tick.admits(q, proxy.cell)) {
    enter(proxy, State::kTet, proxy.cell, kNone);
    return false;
  }
  if (inward < -tick.eps()) {
    if (neighbour == kNone) {
      enter(proxy, State::kOut, kNone, kNone);
      return false;
    }
    if (tick.admits(q, neighbour)) {
      enter(proxy, State::kTet, neighbour, kNone);
      return false;
    }
  }

  const FaceRim& rim = tick.complex.rims()[face_index];
  const Slide slide = slide_on_face(tick, q, face.plane, side, proxy.cell, neighbour);
  if (!slide.motion.moves) {
    // at rest on the rim, what lies around the edge may still let it go on
    if (std::abs(side) > tick.eps()) {
      for (std::size_t i = 0; i < 3; ++i) {
        if (std::abs(rim.inward[i].side(q)) <= tick.eps()) {
          enter(proxy, State::kEdg, proxy.cell, rim.edges[i]);
          return false;
        }
      }
    }
    return true;
  }

  double first = 2.0;
  double deepest = 0.0;
  double nearest = std::numeric_limits<double>::infinity();
  int exit = -1;
  for (int i = 0; i < 3; ++i) {
    const Plane& edge = rim.inward[static_cast<std::size_t>(i)];
    const double after = edge.side(slide.motion.to);
    nearest = std::fmin(nearest, after);
    if (after >= -tick.eps()) continue;
    const double t = crossing(edge.side(q), after);
    if (t < first || (t == first && after < deepest)) {
      first = t;
      deepest = after;
      exit = i;
    }
  }
  if (exit < 0) {
    proxy.position = slide.motion.to;
    spend_time(tick.pull, q, slide.goal, *slide.in, slide.lag, nullptr);
    return nearest > tick.eps();
  }
  proxy.position = q + first * (slide.motion.to - q);
  spend_time(tick.pull, q, slide.goal, *slide.in, slide.lag, &proxy.position);
  enter(proxy, State::kEdg, proxy.cell, rim.edges[static_cast<std::size_t>(exit)]);
  return false;
}

/// The cells around an edge or a vertex in whose direction the HIP lies.
struct Facing {
  Index first = kNone;      // the belonging cell if it is among them, else the first; kNone: there is none
  Index admitting = kNone;  // the first of them that lets the proxy move toward the HIP
};

/// Sorts one cell, whose planes through the feature `holds` tests, into `facing`.
template <class Holds>
void look_at(const Tick& tick, const Proxy& proxy, Index cell, Holds&& holds, Facing& facing) noexcept {
  const bool belonging = cell == proxy.cell;
  if (!belonging && facing.first != kNone && facing.admitting != kNone) return;
  if (!holds(tick.complex.cells()[cell])) return;
  if (belonging || facing.first == kNone) facing.first = cell;
  if ((belonging || facing.admitting == kNone) && tick.admits(proxy.position, cell)) facing.admitting = cell;
}

Facing cells_facing_hip(const Tick& tick, const Proxy& proxy) noexcept {
  Facing facing;
  const glm::dvec3& p = tick.p();
  if (proxy.state == State::kEdg) {
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

/// The material of the fan around an edge in which a proxy moves most easily; the void if the edge is on the
/// hull.
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

/// The face or edge along which a proxy on an edge or a vertex would go if there were no friction: the one on
/// which the foot of the HIP is furthest away, which is the steepest way down.
struct Candidate {
  double distance2 = -1.0;  // |goal - q|^2
  State state = State::kVer;
  Index cell = kNone;
  Index feature = kNone;
  glm::dvec3 goal{0.0, 0.0, 0.0};
  const Material* in = &kVoid;
  const Material* held_by = &kVoid;
};

void consider(const Tick& tick, const glm::dvec3& q, const Candidate& candidate, Candidate& best) noexcept {
  if (candidate.distance2 <= best.distance2) return;
  if (move(tick.pull, q, candidate.goal, *candidate.in).moves) best = candidate;
}

/// A face is a way if one of its cells keeps the HIP out and the other lets the proxy slide.
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
    candidate.state = State::kSur;
    candidate.cell = slides_in == kNone ? kept_out_of : slides_in;
    candidate.feature = face_index;
    candidate.in = &tick.material(slides_in);
    candidate.held_by = &tick.material(kept_out_of);
    consider(tick, q, candidate, best);
  }
}

/// Friction has its say only after the way is chosen.
bool can_leave(const Tick& tick, const glm::dvec3& q, const Candidate& way) noexcept {
  const double lag = friction_lag(tick.pull, *way.held_by, glm::distance(tick.p(), way.goal));
  return move(tick.pull, q, way.goal, *way.in, lag).moves;
}

glm::dvec3 foot_on(const Edge& edge, const glm::dvec3& p) noexcept {
  return edge.origin + glm::dot(p - edge.origin, edge.direction) * edge.direction;
}

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
    enter(proxy, State::kVer, proxy.cell, end);
    return;
  }
  if (motion.moves) {
    proxy.position = motion.to;
    spend_time(tick.pull, q, goal, in, lag, nullptr);
  }
}

// (3) On an edge: into a cell around it, out of the hull, along a face, along the edge.
bool step_edg(Tick& tick, Proxy& proxy) noexcept {
  const Facing facing = cells_facing_hip(tick, proxy);
  if (facing.first == kNone) {
    enter(proxy, State::kOut, kNone, kNone);
    return false;
  }
  if (facing.admitting != kNone) {
    enter(proxy, State::kTet, facing.admitting, kNone);
    return false;
  }

  const glm::dvec3 q = proxy.position;
  Candidate way;
  for (const Index face : tick.complex.faces_of_edge(proxy.feature)) {
    const FaceRim& rim = tick.complex.rims()[face];
    const std::size_t i = rim.edges[0] == proxy.feature ? 0 : (rim.edges[1] == proxy.feature ? 1 : 2);
    if (rim.inward[i].side(tick.p()) > tick.eps()) consider_face(tick, q, face, way);
  }
  if (way.state == State::kSur) {
    if (can_leave(tick, q, way)) {
      enter(proxy, State::kSur, way.cell, way.feature);
      return false;
    }
    const Edge& edge = tick.complex.edges()[proxy.feature];
    const double along = glm::dot(q - edge.origin, edge.direction);
    if (along <= tick.eps())
      enter(proxy, State::kVer, proxy.cell, edge.ends[0]);
    else if (along >= edge.length - tick.eps())
      enter(proxy, State::kVer, proxy.cell, edge.ends[1]);
    return false;
  }
  slide_on_edge(tick, proxy, tick.material(facing.first));
  return false;
}

// (4) On a vertex: into a cell around it, out of the hull, along a face or an edge.
bool step_ver(Tick& tick, Proxy& proxy) noexcept {
  const Facing facing = cells_facing_hip(tick, proxy);
  if (facing.first == kNone) {
    enter(proxy, State::kOut, kNone, kNone);
    return false;
  }
  if (facing.admitting != kNone) {
    enter(proxy, State::kTet, facing.admitting, kNone);
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
    candidate.state = State::kEdg;
    candidate.cell = tick.complex.cells_of_edge(index).front().cell;
    candidate.feature = index;
    candidate.in = &most_permissive(tick, index);
    candidate.held_by = &tick.material(facing.first);
    consider(tick, q, candidate, way);
  }
  if (way.state == State::kVer || !can_leave(tick, q, way)) return true;
  enter(proxy, way.state, way.cell, way.feature);
  return false;
}

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
    enter(at_rim, State::kEdg, kNone, rim.edges[i]);
  } else {
    const std::size_t shared = on_edge[0] && on_edge[1] ? 1 : (on_edge[1] && on_edge[2] ? 2 : 0);
    enter(at_rim, State::kVer, kNone, rim.vertices[shared]);
  }
  return cells_facing_hip(tick, at_rim).first != kNone;
}

// (5) Outside: follow the HIP until its path enters the hull.
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
  enter(proxy, State::kSur, tick.complex.faces()[hit].cells[0], hit);
  return false;
}

bool step(Tick& tick, Proxy& proxy) noexcept {
  switch (proxy.state) {
    case State::kTet:
      return step_tet(tick, proxy);
    case State::kSur:
      return step_sur(tick, proxy);
    case State::kEdg:
      return step_edg(tick, proxy);
    case State::kVer:
      return step_ver(tick, proxy);
    case State::kOut:
      break;
  }
  return step_out(tick, proxy);
}

/// The states that a proxy had at one place, to notice when it goes round in a circle.
class Visited {
 public:
  void forget() noexcept { size_ = 0; }
  /// False if it was there already (or there is no room left to tell).
  bool add(const Proxy& proxy) noexcept {
    const Place place{proxy.state, proxy.cell, proxy.feature};
    for (std::size_t i = 0; i < size_; ++i) {
      if (places_[i] == place) return false;
    }
    if (size_ == places_.size()) return false;
    places_[size_++] = place;
    return true;
  }

 private:
  struct Place {
    State state;
    Index cell, feature;
    bool operator==(const Place&) const = default;
  };
  std::array<Place, 64> places_;
  std::size_t size_ = 0;
};

/// Breaks a circle: names the vertex or edge of the belonging cell that the proxy is at. False if it is at
/// none.
bool relocate(const Tick& tick, Proxy& proxy) noexcept {
  if (proxy.cell == kNone) return false;
  const double reach = kRelocationReach * tick.eps();
  const Cell& cell = tick.complex.cells()[proxy.cell];
  for (const Index vertex : cell.vertices) {
    if (glm::distance(tick.complex.vertices()[vertex], proxy.position) <= reach) {
      enter(proxy, State::kVer, proxy.cell, vertex);
      return true;
    }
  }
  for (const Index face : cell.faces) {
    for (const Index index : tick.complex.rims()[face].edges) {
      const Edge& edge = tick.complex.edges()[index];
      const double along = glm::dot(proxy.position - edge.origin, edge.direction);
      if (along >= 0.0 && along <= edge.length &&
          glm::distance(foot_on(edge, proxy.position), proxy.position) <= reach) {
        enter(proxy, State::kEdg, proxy.cell, index);
        return true;
      }
    }
  }
  return false;
}

double distance2(const glm::dvec3& a, const glm::dvec3& b) noexcept {
  const glm::dvec3 d = a - b;
  return glm::dot(d, d);
}

/// Makes transitions until neither state nor position changes.
template <bool kTimed>
void settle(Tick& tick, Proxy& proxy, TransitionTable& table, Clock clock) noexcept {
  const double eps2 = tick.eps() * tick.eps();
  Visited visited;
  visited.add(proxy);
  int relocations = 0;
  for (int i = 0; i < kTransitionLimit; ++i) {
    const Proxy before = proxy;
    std::uint64_t start = 0;
    if constexpr (kTimed) start = clock();
    const bool settled = step(tick, proxy);
    const auto from = static_cast<std::size_t>(before.state);
    const auto to = static_cast<std::size_t>(proxy.state);
    if constexpr (kTimed) {
      table.nanoseconds[from][to] += clock() - start;
      ++table.timed[from][to];
    }
    ++table.count[from][to];
    if (settled) return;

    const bool same_place =
        before.state == proxy.state && before.cell == proxy.cell && before.feature == proxy.feature;
    const bool moved = distance2(before.position, proxy.position) > eps2;
    if (same_place && !moved) return;
    if (moved) visited.forget();
    if (!visited.add(proxy)) {
      if (relocations == kRelocationLimit || !relocate(tick, proxy)) return;
      ++relocations;
      ++table.relocations;
      visited.forget();
      visited.add(proxy);
    }
  }
  ++table.limited;
}

}  // namespace

bool is_permitted(ConstraintState before, ConstraintState after) noexcept {
  constexpr bool kPermitted[kConstraintStates][kConstraintStates] = {
      // Tet   Sur    Edg    Ver    Out
      {true, true, false, false, false},  // Tet
      {true, true, true, false, true},    // Sur
      {true, true, true, true, true},     // Edg
      {true, true, true, true, true},     // Ver
      {false, true, false, false, true},  // Out
  };
  return kPermitted[static_cast<int>(before)][static_cast<int>(after)];
}

void start_proxy(const ConstraintModel& model, const glm::dvec3& hip, Proxy& proxy) noexcept {
  proxy = Proxy{};
  proxy.position = hip;
  const double eps = model.cells.tolerance();
  bool inside_rigid = false;
  const Index cell = model.cells.locate_if(hip, [&](Index index) {
    const Cell& candidate = model.cells.cells()[index];
    if (!is_rigid(model.materials[candidate.region])) return true;
    bool on_hull = false;
    for (int i = 0; i < 4; ++i) {
      if (candidate.neighbours[static_cast<std::size_t>(i)] == kNone && candidate.side(i, hip) <= eps)
        on_hull = true;
    }
    inside_rigid = inside_rigid || !on_hull;
    return false;
  });
  if (cell != kNone)
    enter(proxy, State::kTet, cell, kNone);
  else
    proxy.swallowed = inside_rigid;
}

void constrain(const ConstraintModel& model, const glm::dvec3& hip, double stiffness, double dt, Proxy& proxy,
               TransitionTable& table, Clock clock) noexcept {
  if (proxy.swallowed) {
    start_proxy(model, hip, proxy);
    return;
  }
  const double eps = model.cells.tolerance();
  Tick tick{model.cells, model.materials, {hip, stiffness, eps, dt, proxy.slipping}};
  const glm::dvec3 start = proxy.position;
  if (clock == nullptr)
    settle<false>(tick, proxy, table, clock);
  else
    settle<true>(tick, proxy, table, clock);
  proxy.slipping = distance2(start, proxy.position) > eps * eps;
}

}  // namespace haptic::engine
