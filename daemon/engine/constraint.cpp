#include "engine/constraint.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "engine/constants.h"
#include "engine/constraint/ways.h"

namespace haptic::engine {
namespace {

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
    ConstraintState state;
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
      enter(proxy, ConstraintState::kVer, proxy.cell, vertex);
      return true;
    }
  }
  for (const Index face : cell.faces) {
    for (const Index index : tick.complex.rims()[face].edges) {
      const Edge& edge = tick.complex.edges()[index];
      const double along = glm::dot(proxy.position - edge.origin, edge.direction);
      if (along >= 0.0 && along <= edge.length &&
          glm::distance(foot_on(edge, proxy.position), proxy.position) <= reach) {
        enter(proxy, ConstraintState::kEdg, proxy.cell, index);
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

bool step(Tick& tick, Proxy& proxy) noexcept {
  switch (proxy.state) {
    case ConstraintState::kTet:
      return step_tet(tick, proxy);
    case ConstraintState::kSur:
      return step_sur(tick, proxy);
    case ConstraintState::kEdg:
      return step_edg(tick, proxy);
    case ConstraintState::kVer:
      return step_ver(tick, proxy);
    case ConstraintState::kOut:
      break;
  }
  return step_out(tick, proxy);
}

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
    enter(proxy, ConstraintState::kTet, cell, kNone);
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
