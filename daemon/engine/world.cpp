#include "engine/world.h"

#include <glm/geometric.hpp>
#include <utility>

namespace haptic::engine {
namespace {

// An object's frame in one tick, as a matrix: many points are taken through it.
struct Frame {
  explicit Frame(const Pose& world_from_object) noexcept
      : origin(world_from_object.position), rotation(glm::mat3_cast(world_from_object.orientation)) {}

  glm::dvec3 to_object(const glm::dvec3& p_world) const noexcept { return (p_world - origin) * rotation; }
  glm::dvec3 turn_to_world(const glm::dvec3& v_object) const noexcept { return rotation * v_object; }

  glm::dvec3 origin;
  glm::dmat3 rotation;
};

bool is_movable(const Object& object) noexcept { return object.dynamic && object.dynamics.mass.mass > 0.0; }

// Whether the state machine could only find what this finds: a proxy outside whose path stays clear of the
// object. Then the proxy is moved and its transition counted.
bool pass_by(const CellComplex& cells, const glm::dvec3& hip, Proxy& proxy, TransitionTable& table) noexcept {
  if (proxy.state != ConstraintState::kOut || proxy.swallowed) return false;
  const double eps = cells.tolerance();
  Box path;
  path.add(proxy.position);
  path.add(hip);
  path.low -= eps;
  path.high += eps;
  if (path.overlaps(cells.bounds())) return false;
  const glm::dvec3 step = hip - proxy.position;
  proxy.slipping = glm::dot(step, step) > eps * eps;
  proxy.position = hip;
  constexpr auto kOut = static_cast<std::size_t>(ConstraintState::kOut);
  ++table.count[kOut][kOut];
  return true;
}

// A proxy whose finger is gone holds on to nothing.
void let_go(Proxy& proxy) noexcept {
  const glm::dvec3 position = proxy.position;
  proxy = Proxy{};
  proxy.position = position;
}

bool holds(const Proxy& proxy) noexcept { return proxy.state != ConstraintState::kOut && !proxy.swallowed; }

}  // namespace

World::World(std::shared_ptr<const Scene> scene)
    : scene_(std::move(scene)),
      initial_(initial_state(*scene_)),
      state_(initial_),
      present_(scene_->fingers.size()) {}

void World::step(std::span<const FingerPose> fingers, double dt, Clock clock) noexcept {
  move_bodies(dt);
  place_hips(fingers);
  for (std::size_t object = 0; object < scene_->objects.size(); ++object) constrain_hips(object, dt, clock);
  sum_forces(fingers);
  ++state_.ticks;
}

void World::reset() noexcept {
  restore(initial_);
  transitions_ = TransitionTable{};
}

bool World::restore(const State& state) noexcept {
  if (state.bodies.size() != initial_.bodies.size() || state.proxies.size() != initial_.proxies.size() ||
      state.contact_forces.size() != initial_.contact_forces.size() ||
      state.hip_positions.size() != initial_.hip_positions.size() ||
      state.hip_forces.size() != initial_.hip_forces.size() ||
      state.finger_wrenches.size() != initial_.finger_wrenches.size() ||
      state.finger_started.size() != initial_.finger_started.size()) {
    return false;
  }
  // vectors of equal sizes: nothing is allocated
  state_ = state;
  return true;
}

bool World::carry_over(const World& before, const CarryMap& map) noexcept {
  if (!fits(before, map)) return false;
  reset();
  state_.ticks = before.state_.ticks;
  transitions_ = before.transitions_;
  for (std::size_t object = 0; object < state_.bodies.size(); ++object) {
    const CarriedObject& carried = map.objects[object];
    if (carried.from == kNone) continue;
    const BodyState& old = before.state_.bodies[carried.from];
    if (carried.motion) {
      state_.bodies[object] = old;
    } else {
      state_.bodies[object].world_from_object = old.world_from_object;
    }
  }
  for (std::size_t finger = 0; finger < present_.size(); ++finger) carry_finger(before, map, finger);
  sum_hip_forces();
  return true;
}

bool World::fits(const World& before, const CarryMap& map) const noexcept {
  if (map.objects.size() != state_.bodies.size() || map.fingers.size() != present_.size()) return false;
  const Scene& old = *before.scene_;
  for (std::size_t i = 0; i < map.objects.size(); ++i) {
    const CarriedObject& carried = map.objects[i];
    if (carried.from == kNone) continue;
    if (carried.from >= old.objects.size()) return false;
    // a proxy means something in its own cells only
    if (carried.contacts && old.objects[carried.from].cells != scene_->objects[i].cells) return false;
  }
  for (std::size_t f = 0; f < map.fingers.size(); ++f) {
    const Index from = map.fingers[f];
    if (from == kNone) continue;
    if (from >= old.fingers.size()) return false;
    if (old.fingers[from].hips.size() != scene_->fingers[f].hips.size()) return false;
  }
  return true;
}

void World::carry_finger(const World& before, const CarryMap& map, std::size_t finger) noexcept {
  const Index from = map.fingers[finger];
  if (from == kNone) return;
  const State& old = before.state_;
  const std::size_t first = scene_->fingers[finger].first_hip;
  const std::size_t old_first = before.scene_->fingers[from].first_hip;
  state_.finger_started[finger] = old.finger_started[from];
  state_.finger_wrenches[finger] = old.finger_wrenches[from];
  for (std::size_t i = 0; i < scene_->fingers[finger].hips.size(); ++i) {
    state_.hip_positions[first + i] = old.hip_positions[old_first + i];
  }
  for (std::size_t object = 0; object < state_.bodies.size(); ++object) {
    for (std::size_t i = 0; i < scene_->fingers[finger].hips.size(); ++i) {
      carry_contact(before, map, object, finger, i);
    }
  }
}

void World::carry_contact(const World& before, const CarryMap& map, std::size_t object, std::size_t finger,
                          std::size_t hip) noexcept {
  const CarriedObject& carried = map.objects[object];
  const std::size_t now = scene_->fingers[finger].first_hip + hip;
  const std::size_t contact = object * scene_->hip_count + now;
  if (carried.from != kNone && carried.contacts) {
    const std::size_t old_hip = before.scene_->fingers[map.fingers[finger]].first_hip + hip;
    const std::size_t old = carried.from * before.scene_->hip_count + old_hip;
    state_.proxies[contact] = before.state_.proxies[old];
    state_.contact_forces[contact] = before.state_.contact_forces[old];
    return;
  }
  // a finger that is not there is started by step() when it comes
  if (state_.finger_started[finger] == 0) return;
  const Object& fresh = scene_->objects[object];
  const Frame frame(state_.bodies[object].world_from_object);
  start_proxy({*fresh.cells, fresh.materials}, frame.to_object(state_.hip_positions[now]),
              state_.proxies[contact]);
}

glm::dvec3 World::proxy_in_world(std::size_t object, std::size_t hip) const noexcept {
  return state_.bodies[object].world_from_object * state_.proxies[object * scene_->hip_count + hip].position;
}

void World::move_bodies(double dt) noexcept {
  if (state_.ticks == 0) return;
  const double from = static_cast<double>(state_.ticks - 1) * dt;
  for (std::size_t i = 0; i < state_.bodies.size(); ++i) {
    const Object& object = scene_->objects[i];
    if (!is_movable(object) || from < object.release_after) continue;
    integrate(object.dynamics, scene_->gravity, dt, state_.bodies[i]);
  }
}

void World::place_hips(std::span<const FingerPose> fingers) noexcept {
  for (std::size_t f = 0; f < present_.size(); ++f) {
    const Finger& finger = scene_->fingers[f];
    present_[f] = f < fingers.size() && is_usable(fingers[f]) ? 1 : 0;
    if (present_[f] == 0) continue;
    for (std::size_t i = 0; i < finger.hips.size(); ++i) {
      state_.hip_positions[finger.first_hip + i] = fingers[f].world_from_device * finger.hips[i];
    }
  }
}

void World::constrain_hips(std::size_t object_index, double dt, Clock clock) noexcept {
  const Object& object = scene_->objects[object_index];
  const ConstraintModel model{*object.cells, object.materials};
  BodyState& body = state_.bodies[object_index];
  const Frame frame(body.world_from_object);
  const glm::dvec3& centre = object.dynamics.mass.object_from_gravity_centre.position;

  glm::dvec3 force{0.0};   // on the object, world
  glm::dvec3 torque{0.0};  // about its centre of gravity, object frame
  for (std::size_t f = 0; f < present_.size(); ++f) {
    const Finger& finger = scene_->fingers[f];
    for (std::size_t hip = finger.first_hip; hip < finger.first_hip + finger.hips.size(); ++hip) {
      const std::size_t contact = object_index * scene_->hip_count + hip;
      Proxy& proxy = state_.proxies[contact];
      glm::dvec3& on_user = state_.contact_forces[contact];
      on_user = glm::dvec3{0.0};
      if (present_[f] == 0) {
        let_go(proxy);
        continue;
      }
      const glm::dvec3 p = frame.to_object(state_.hip_positions[hip]);
      if (state_.finger_started[f] == 0) {
        start_proxy(model, p, proxy);
        continue;
      }
      if (pass_by(*object.cells, p, proxy, transitions_)) continue;
      constrain(model, p, finger.stiffness, dt, proxy, transitions_, clock);
      if (!holds(proxy)) continue;
      // the force is along q - p: its torque is the same about either end
      const glm::dvec3 pull = finger.stiffness * (proxy.position - p);
      on_user = frame.turn_to_world(pull);
      force -= on_user;
      torque -= glm::cross(proxy.position - centre, pull);
    }
  }
  body.applied = {force, frame.turn_to_world(torque)};
}

void World::sum_hip_forces() noexcept {
  for (std::size_t hip = 0; hip < scene_->hip_count; ++hip) {
    glm::dvec3 sum{0.0};
    for (std::size_t object = 0; object < scene_->objects.size(); ++object) {
      sum += state_.contact_forces[object * scene_->hip_count + hip];
    }
    state_.hip_forces[hip] = sum;
  }
}

void World::sum_forces(std::span<const FingerPose> fingers) noexcept {
  sum_hip_forces();
  for (std::size_t f = 0; f < present_.size(); ++f) {
    const Finger& finger = scene_->fingers[f];
    const std::size_t count = finger.hips.size();
    state_.finger_wrenches[f] =
        present_[f] == 0 ? Wrench{}
                         : sum_wrench(std::span(state_.hip_positions).subspan(finger.first_hip, count),
                                      std::span(state_.hip_forces).subspan(finger.first_hip, count),
                                      fingers[f].world_from_device.position);
    state_.finger_started[f] = present_[f];
  }
}

}  // namespace haptic::engine
