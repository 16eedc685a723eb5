#include "engine/state.h"

#include <bit>

namespace haptic::engine {
namespace {

// FNV-1a, 64 bits, over the bytes of each value from the lowest up, whatever the machine's byte order
class Fnv {
 public:
  void add(std::uint64_t bits, int bytes) noexcept {
    for (int i = 0; i < bytes; ++i) {
      value_ = (value_ ^ ((bits >> (8 * i)) & 0xffU)) * kPrime;
    }
  }
  void add(std::uint64_t value) noexcept { add(value, 8); }
  void add(Index value) noexcept { add(value, 4); }
  void add(std::uint8_t value) noexcept { add(value, 1); }
  void add(bool value) noexcept { add(value ? 1U : 0U, 1); }
  void add(ConstraintState value) noexcept { add(static_cast<std::uint8_t>(value)); }
  void add(double value) noexcept { add(std::bit_cast<std::uint64_t>(value)); }
  void add(const glm::dvec3& value) noexcept {
    add(value.x);
    add(value.y);
    add(value.z);
  }
  void add(const glm::dquat& value) noexcept {
    add(value.w);
    add(value.x);
    add(value.y);
    add(value.z);
  }
  void add(const Pose& value) noexcept {
    add(value.position);
    add(value.orientation);
  }
  void add(const Wrench& value) noexcept {
    add(value.force);
    add(value.torque);
  }
  void add(const BodyState& value) noexcept {
    add(value.world_from_object);
    add(value.velocity);
    add(value.angular_momentum);
    add(value.applied);
  }
  void add(const Proxy& value) noexcept {
    add(value.position);
    add(value.cell);
    add(value.feature);
    add(value.state);
    add(value.slipping);
    add(value.swallowed);
  }
  template <class T>
  void add(const std::vector<T>& values) noexcept {
    add(static_cast<std::uint64_t>(values.size()));
    for (const T& value : values) add(value);
  }

  std::uint64_t value() const noexcept { return value_; }

 private:
  static constexpr std::uint64_t kPrime = 0x100000001b3U;
  std::uint64_t value_ = 0xcbf29ce484222325U;
};

}  // namespace

State initial_state(const Scene& scene) {
  State state;
  state.bodies.resize(scene.objects.size());
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    state.bodies[i].world_from_object = scene.objects[i].initial_pose;
  }
  state.proxies.resize(scene.objects.size() * scene.hip_count);
  state.contact_forces.resize(state.proxies.size());
  state.hip_positions.resize(scene.hip_count);
  state.hip_forces.resize(scene.hip_count);
  state.finger_wrenches.resize(scene.fingers.size());
  state.finger_started.resize(scene.fingers.size());
  return state;
}

std::uint64_t hash(const State& state) noexcept {
  Fnv fnv;
  fnv.add(state.ticks);
  fnv.add(state.bodies);
  fnv.add(state.proxies);
  fnv.add(state.contact_forces);
  fnv.add(state.hip_positions);
  fnv.add(state.hip_forces);
  fnv.add(state.finger_wrenches);
  fnv.add(state.finger_started);
  return fnv.value();
}

}  // namespace haptic::engine
