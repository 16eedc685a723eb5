#include "load/state_message.h"

#include <cmath>
#include <string>

#include "load/error.h"
#include "load/text_message.h"

namespace haptic::load {
namespace {

using Doubles = google::protobuf::RepeatedField<double>;
using engine::Index;

// the schema counts from 1, and kNone becomes 0
constexpr std::uint32_t to_wire(Index index) noexcept { return index + 1U; }
constexpr Index from_wire(std::uint32_t number) noexcept { return number - 1U; }
static_assert(to_wire(engine::kNone) == 0 && from_wire(0) == engine::kNone);

static_assert(static_cast<int>(engine::ConstraintState::kTet) == v1::TET);
static_assert(static_cast<int>(engine::ConstraintState::kOut) == v1::OUT);

void add(Doubles& out, const glm::dvec3& v) {
  out.Add(v.x);
  out.Add(v.y);
  out.Add(v.z);
}

void add(Doubles& out, const glm::dquat& q) {
  out.Add(q.w);
  out.Add(q.x);
  out.Add(q.y);
  out.Add(q.z);
}

[[noreturn]] void fail(const std::string& field, const std::string& message) {
  throw LoadError({.file = {}, .line = 0, .column = 0, .field = "state." + field}, message);
}

template <class List>
void check_size(const List& list, const char* field, std::size_t items, std::size_t each = 1) {
  if (static_cast<std::size_t>(list.size()) == items * each) return;
  fail(field,
       "has " + std::to_string(list.size()) + " items where the scene needs " + std::to_string(items * each));
}

void check_numbers(const Doubles& list, const char* field, std::size_t items, std::size_t each) {
  check_size(list, field, items, each);
  for (int i = 0; i < list.size(); ++i) {
    if (!std::isfinite(list[i])) fail(item(field, i), "is no finite number");
  }
}

glm::dvec3 vector(const Doubles& list, std::size_t item) {
  const int i = static_cast<int>(3 * item);
  return {list[i], list[i + 1], list[i + 2]};
}

glm::dquat quaternion(const Doubles& list, std::size_t item) {
  const int i = static_cast<int>(4 * item);
  return {list[i], list[i + 1], list[i + 2], list[i + 3]};
}

void check_sizes(const v1::WorldState& message, const engine::Scene& scene) {
  const std::size_t objects = scene.objects.size();
  const std::size_t contacts = objects * scene.hip_count;
  check_numbers(message.position(), "position", objects, 3);
  check_numbers(message.orientation(), "orientation", objects, 4);
  check_numbers(message.velocity(), "velocity", objects, 3);
  check_numbers(message.angular_momentum(), "angular_momentum", objects, 3);
  check_numbers(message.force(), "force", objects, 3);
  check_numbers(message.torque(), "torque", objects, 3);
  check_numbers(message.hip_position(), "hip_position", scene.hip_count, 3);
  check_numbers(message.hip_force(), "hip_force", scene.hip_count, 3);
  check_numbers(message.finger_force(), "finger_force", scene.fingers.size(), 3);
  check_numbers(message.finger_torque(), "finger_torque", scene.fingers.size(), 3);
  check_size(message.finger_started(), "finger_started", scene.fingers.size());
  check_numbers(message.proxy_position(), "proxy_position", contacts, 3);
  check_size(message.proxy_cell(), "proxy_cell", contacts);
  check_size(message.proxy_feature(), "proxy_feature", contacts);
  check_size(message.proxy_state(), "proxy_state", contacts);
  check_size(message.proxy_slipping(), "proxy_slipping", contacts);
  check_size(message.proxy_swallowed(), "proxy_swallowed", contacts);
  check_numbers(message.contact_force(), "contact_force", contacts, 3);
}

// the state machine looks these numbers up without asking
bool is_somewhere(const engine::Proxy& proxy, const engine::CellComplex& cells) {
  const bool in_a_cell = proxy.cell < cells.cells().size() && !proxy.swallowed;
  switch (proxy.state) {
    case engine::ConstraintState::kTet:
      return in_a_cell && proxy.feature == engine::kNone;
    case engine::ConstraintState::kSur: {
      if (!in_a_cell || proxy.feature >= cells.faces().size()) return false;
      const engine::Face& face = cells.faces()[proxy.feature];
      return face.cells[0] == proxy.cell || face.cells[1] == proxy.cell;
    }
    case engine::ConstraintState::kEdg:
      return in_a_cell && proxy.feature < cells.edges().size();
    case engine::ConstraintState::kVer:
      return in_a_cell && proxy.feature < cells.vertices().size();
    case engine::ConstraintState::kOut:
      return proxy.cell == engine::kNone && proxy.feature == engine::kNone;
  }
  return false;
}

engine::Proxy read_proxy(const v1::WorldState& message, std::size_t contact,
                         const engine::CellComplex& cells) {
  const int i = static_cast<int>(contact);
  if (!v1::ConstraintState_IsValid(message.proxy_state(i))) {
    fail(item("proxy_state", i), "is no state of a proxy");
  }
  const engine::Proxy proxy{.position = vector(message.proxy_position(), contact),
                            .cell = from_wire(message.proxy_cell(i)),
                            .feature = from_wire(message.proxy_feature(i)),
                            .state = static_cast<engine::ConstraintState>(message.proxy_state(i)),
                            .slipping = message.proxy_slipping(i),
                            .swallowed = message.proxy_swallowed(i)};
  if (!is_somewhere(proxy, cells)) fail(item("proxy_cell", i), "the proxy is nowhere in its object");
  return proxy;
}

}  // namespace

void write_state(const engine::State& state, v1::WorldState& message) {
  message.set_state_hash(engine::hash(state));
  message.set_world_ticks(state.ticks);
  for (const engine::BodyState& body : state.bodies) {
    add(*message.mutable_position(), body.world_from_object.position);
    add(*message.mutable_orientation(), body.world_from_object.orientation);
    add(*message.mutable_velocity(), body.velocity);
    add(*message.mutable_angular_momentum(), body.angular_momentum);
    add(*message.mutable_force(), body.applied.force);
    add(*message.mutable_torque(), body.applied.torque);
  }
  for (const glm::dvec3& position : state.hip_positions) add(*message.mutable_hip_position(), position);
  for (const glm::dvec3& force : state.hip_forces) add(*message.mutable_hip_force(), force);
  for (const engine::Wrench& wrench : state.finger_wrenches) {
    add(*message.mutable_finger_force(), wrench.force);
    add(*message.mutable_finger_torque(), wrench.torque);
  }
  for (const std::uint8_t started : state.finger_started) message.add_finger_started(started != 0);
  for (const engine::Proxy& proxy : state.proxies) {
    add(*message.mutable_proxy_position(), proxy.position);
    message.add_proxy_cell(to_wire(proxy.cell));
    message.add_proxy_feature(to_wire(proxy.feature));
    message.add_proxy_state(static_cast<v1::ConstraintState>(proxy.state));
    message.add_proxy_slipping(proxy.slipping);
    message.add_proxy_swallowed(proxy.swallowed);
  }
  for (const glm::dvec3& force : state.contact_forces) add(*message.mutable_contact_force(), force);
}

engine::State read_state(const v1::WorldState& message, const engine::Scene& scene) {
  check_sizes(message, scene);
  engine::State state = engine::initial_state(scene);
  state.ticks = message.world_ticks();
  for (std::size_t i = 0; i < state.bodies.size(); ++i) {
    state.bodies[i] = {
        .world_from_object = {vector(message.position(), i), quaternion(message.orientation(), i)},
        .velocity = vector(message.velocity(), i),
        .angular_momentum = vector(message.angular_momentum(), i),
        .applied = {vector(message.force(), i), vector(message.torque(), i)}};
  }
  for (std::size_t i = 0; i < scene.hip_count; ++i) {
    state.hip_positions[i] = vector(message.hip_position(), i);
    state.hip_forces[i] = vector(message.hip_force(), i);
  }
  for (std::size_t i = 0; i < scene.fingers.size(); ++i) {
    state.finger_wrenches[i] = {vector(message.finger_force(), i), vector(message.finger_torque(), i)};
    state.finger_started[i] = message.finger_started(static_cast<int>(i)) ? 1 : 0;
  }
  for (std::size_t i = 0; i < state.proxies.size(); ++i) {
    state.proxies[i] = read_proxy(message, i, *scene.objects[i / scene.hip_count].cells);
    state.contact_forces[i] = vector(message.contact_force(), i);
  }
  return state;
}

}  // namespace haptic::load
