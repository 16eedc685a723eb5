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

void World::sum_forces(std::span<const FingerPose> fingers) noexcept {
  for (std::size_t hip = 0; hip < scene_->hip_count; ++hip) {
    glm::dvec3 sum{0.0};
    for (std::size_t object = 0; object < scene_->objects.size(); ++object) {
      sum += state_.contact_forces[object * scene_->hip_count + hip];
    }
    state_.hip_forces[hip] = sum;
  }
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
