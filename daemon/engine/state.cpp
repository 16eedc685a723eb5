#include "engine/state.h"

#include <array>
#include <bit>

namespace haptic::engine {
namespace {

std::uint64_t bits_of(double value) noexcept { return std::bit_cast<std::uint64_t>(value); }

// XXH64 (xxhash.com) over rows of 32 bytes, without what it does with shorter ends. Four lanes that do not
// wait for each other: hashing costs no more than copying.
class Xxh64 {
 public:
  void add(std::uint64_t a, std::uint64_t b, std::uint64_t c, std::uint64_t d) noexcept {
    lanes_[0] = mix(lanes_[0], a);
    lanes_[1] = mix(lanes_[1], b);
    lanes_[2] = mix(lanes_[2], c);
    lanes_[3] = mix(lanes_[3], d);
    bytes_ += 32;
  }
  void add(double a, double b, double c, double d) noexcept {
    add(bits_of(a), bits_of(b), bits_of(c), bits_of(d));
  }
  void add(const glm::dvec3& v, std::uint64_t last) noexcept {
    add(bits_of(v.x), bits_of(v.y), bits_of(v.z), last);
  }

  std::uint64_t value() const noexcept {
    std::uint64_t h = std::rotl(lanes_[0], 1) + std::rotl(lanes_[1], 7) + std::rotl(lanes_[2], 12) +
                      std::rotl(lanes_[3], 18);
    for (const std::uint64_t lane : lanes_) h = (h ^ mix(0, lane)) * kPrime1 + kPrime4;
    h += bytes_;
    h = (h ^ (h >> 33U)) * kPrime2;
    h = (h ^ (h >> 29U)) * kPrime3;
    return h ^ (h >> 32U);
  }

 private:
  static constexpr std::uint64_t kPrime1 = 0x9e3779b185ebca87U;
  static constexpr std::uint64_t kPrime2 = 0xc2b2ae3d27d4eb4fU;
  static constexpr std::uint64_t kPrime3 = 0x165667b19e3779f9U;
  static constexpr std::uint64_t kPrime4 = 0x85ebca77c2b2ae63U;

  static std::uint64_t mix(std::uint64_t lane, std::uint64_t word) noexcept {
    return std::rotl(lane + word * kPrime2, 31) * kPrime1;
  }

  std::array<std::uint64_t, 4> lanes_{kPrime1 + kPrime2, kPrime2, 0, 0 - kPrime1};
  std::uint64_t bytes_ = 0;
};

void add(Xxh64& hash, const BodyState& body) noexcept {
  const Pose& pose = body.world_from_object;
  const glm::dvec3& v = body.velocity;
  const glm::dvec3& l = body.angular_momentum;
  const glm::dvec3& f = body.applied.force;
  hash.add(pose.position, bits_of(pose.orientation.w));
  hash.add(pose.orientation.x, pose.orientation.y, pose.orientation.z, v.x);
  hash.add(v.y, v.z, l.x, l.y);
  hash.add(l.z, f.x, f.y, f.z);
  hash.add(body.applied.torque, 0);
}

void add(Xxh64& hash, const Proxy& proxy, const glm::dvec3& force) noexcept {
  const std::uint64_t flags = static_cast<std::uint64_t>(proxy.state) | (proxy.slipping ? 0x100U : 0U) |
                              (proxy.swallowed ? 0x200U : 0U);
  hash.add(proxy.position, proxy.cell | static_cast<std::uint64_t>(proxy.feature) << 32U);
  hash.add(force, flags);
}

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
  Xxh64 hash;
  hash.add(state.ticks, state.bodies.size(), state.proxies.size(), state.contact_forces.size());
  hash.add(state.hip_positions.size(), state.hip_forces.size(), state.finger_wrenches.size(),
           state.finger_started.size());
  for (const BodyState& body : state.bodies) add(hash, body);
  for (std::size_t i = 0; i < state.proxies.size(); ++i) add(hash, state.proxies[i], state.contact_forces[i]);
  for (const glm::dvec3& position : state.hip_positions) hash.add(position, 0);
  for (const glm::dvec3& force : state.hip_forces) hash.add(force, 0);
  for (std::size_t i = 0; i < state.finger_wrenches.size(); ++i) {
    hash.add(state.finger_wrenches[i].force, state.finger_started[i]);
    hash.add(state.finger_wrenches[i].torque, 0);
  }
  return hash.value();
}

}  // namespace haptic::engine
