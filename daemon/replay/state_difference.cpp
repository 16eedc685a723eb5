#include "replay/state_difference.h"

#include <array>
#include <bit>
#include <charconv>
#include <span>

namespace haptic::replay {

namespace {

using Doubles = google::protobuf::RepeatedField<double>;

constexpr const char* kAxes[] = {"x", "y", "z"};
constexpr const char* kTurns[] = {"w", "x", "y", "z"};

// the shortest text that reads back as this number: two that differ in their last bit look different
std::string text_of(double value) {
  char text[32];
  const std::to_chars_result end = std::to_chars(text, text + sizeof text, value);
  return {text, end.ptr};
}

class Finder {
 public:
  const std::string& found() const noexcept { return found_; }

  /// Compares item `index` of the list, if there is one.
  void compare(const std::string& whose, const char* quantity, const Doubles& recorded, std::size_t index,
               std::span<const double> now, std::span<const char* const> names) {
    const std::size_t first = index * now.size();
    if (!found_.empty() || first + now.size() > static_cast<std::size_t>(recorded.size())) return;
    for (std::size_t i = 0; i < now.size(); ++i) {
      const double then = recorded[static_cast<int>(first + i)];
      if (std::bit_cast<std::uint64_t>(then) == std::bit_cast<std::uint64_t>(now[i])) continue;
      found_ =
          whose + ": " + quantity + "." + names[i] + " is " + text_of(now[i]) + ", recorded " + text_of(then);
      return;
    }
  }

  void compare(const std::string& whose, const char* quantity, const Doubles& recorded, std::size_t index,
               const glm::dvec3& now) {
    compare(whose, quantity, recorded, index, std::array{now.x, now.y, now.z}, kAxes);
  }

 private:
  std::string found_;
};

// of a subscription that selects, `chosen` tells which ones the lists are of
std::size_t index_of(const google::protobuf::RepeatedField<std::uint32_t>& chosen, std::size_t item) {
  return chosen.empty() ? item : chosen[static_cast<int>(item)];
}

void compare_objects(const v1::ObjectsFrame& recorded, const engine::World& world, Finder& finder) {
  const engine::Scene& scene = world.scene();
  const std::size_t count = static_cast<std::size_t>(recorded.position_size()) / 3;
  for (std::size_t item = 0; item < count; ++item) {
    const std::size_t i = index_of(recorded.object(), item);
    if (i >= scene.objects.size()) return;
    const engine::BodyState& body = world.state().bodies[i];
    const std::string whose = "object " + scene.objects[i].name;
    const glm::dquat& turn = body.world_from_object.orientation;
    finder.compare(whose, "position", recorded.position(), item, body.world_from_object.position);
    finder.compare(whose, "orientation", recorded.orientation(), item,
                   std::array{turn.w, turn.x, turn.y, turn.z}, kTurns);
    finder.compare(whose, "velocity", recorded.velocity(), item, body.velocity);
    finder.compare(whose, "force", recorded.force(), item, body.applied.force);
    finder.compare(whose, "torque", recorded.torque(), item, body.applied.torque);
  }
}

std::string name_of_hip(const engine::Scene& scene, std::size_t hip) {
  for (const engine::Finger& finger : scene.fingers) {
    if (hip < finger.first_hip + finger.hips.size()) {
      return "HIP " + std::to_string(hip - finger.first_hip) + " of finger " + finger.name;
    }
  }
  return "HIP " + std::to_string(hip);
}

void compare_hips(const v1::HipsFrame& recorded, const engine::World& world, Finder& finder) {
  const engine::State& state = world.state();
  const std::size_t count = static_cast<std::size_t>(recorded.position_size()) / 3;
  for (std::size_t item = 0; item < count; ++item) {
    const std::size_t hip = index_of(recorded.hip(), item);
    if (hip >= state.hip_positions.size()) return;
    const std::string whose = name_of_hip(world.scene(), hip);
    finder.compare(whose, "position", recorded.position(), item, state.hip_positions[hip]);
    finder.compare(whose, "force", recorded.force(), item, state.hip_forces[hip]);
  }
}

}  // namespace

std::string find_difference(const v1::Frame& recorded, const engine::World& world) {
  Finder finder;
  // what moved a HIP comes before what it moved
  compare_hips(recorded.hips(), world, finder);
  compare_objects(recorded.objects(), world, finder);
  return finder.found();
}

}  // namespace haptic::replay
