#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/constraint/tick.h"

namespace haptic::engine {
namespace {

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

}  // namespace

bool step_sur(Tick& tick, Proxy& proxy) noexcept {
  const Index face_index = proxy.feature;
  const Face& face = tick.complex.faces()[face_index];
  const glm::dvec3 q = proxy.position;
  const double side = face.plane.side(tick.p());  // positive toward cells[0]
  const double inward = face.cells[0] == proxy.cell ? side : -side;
  const Index neighbour = other_cell(face, proxy.cell);

  if (inward > tick.eps() && tick.admits(q, proxy.cell)) {
    enter(proxy, ConstraintState::kTet, proxy.cell, kNone);
    return false;
  }
  if (inward < -tick.eps()) {
    if (neighbour == kNone) {
      enter(proxy, ConstraintState::kOut, kNone, kNone);
      return false;
    }
    if (tick.admits(q, neighbour)) {
      enter(proxy, ConstraintState::kTet, neighbour, kNone);
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
          enter(proxy, ConstraintState::kEdg, proxy.cell, rim.edges[i]);
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
    nearest = std::min(nearest, after);
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
  enter(proxy, ConstraintState::kEdg, proxy.cell, rim.edges[static_cast<std::size_t>(exit)]);
  return false;
}

}  // namespace haptic::engine
