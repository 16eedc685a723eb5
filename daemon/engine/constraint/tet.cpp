#include "engine/constraint/tick.h"

namespace haptic::engine {

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
  enter(proxy, ConstraintState::kSur, proxy.cell, cell.faces[static_cast<std::size_t>(exit)]);
  return false;
}

}  // namespace haptic::engine
