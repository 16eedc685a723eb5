#include "engine/state.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>

namespace haptic::engine {
namespace {

Scene two_objects_three_hips() {
  Scene scene;
  scene.objects.resize(2);
  scene.objects[1].initial_pose.position = {1.0, 2.0, 3.0};
  scene.fingers.resize(2);
  scene.fingers[0].hips.resize(1);
  scene.fingers[1].hips.resize(2);
  number_hips(scene);
  return scene;
}

struct Change {
  std::string field;
  std::function<void(State&)> make;
};

void change_vector(std::vector<Change>& changes, const std::string& field,
                   const std::function<glm::dvec3&(State&)>& get) {
  for (int axis = 0; axis < 3; ++axis) {
    changes.push_back({field + std::to_string(axis), [=](State& s) { get(s)[axis] += 1.0; }});
  }
}

// every field that a State has, once
std::vector<Change> every_change() {
  std::vector<Change> changes;
  changes.push_back({"ticks", [](State& s) { ++s.ticks; }});
  change_vector(changes, "position",
                [](State& s) -> glm::dvec3& { return s.bodies[1].world_from_object.position; });
  for (int i = 0; i < 4; ++i) {
    changes.push_back({"orientation" + std::to_string(i),
                       [=](State& s) { s.bodies[1].world_from_object.orientation[i] += 1.0; }});
  }
  change_vector(changes, "velocity", [](State& s) -> glm::dvec3& { return s.bodies[1].velocity; });
  change_vector(changes, "angular_momentum",
                [](State& s) -> glm::dvec3& { return s.bodies[1].angular_momentum; });
  change_vector(changes, "applied.force", [](State& s) -> glm::dvec3& { return s.bodies[1].applied.force; });
  change_vector(changes, "applied.torque",
                [](State& s) -> glm::dvec3& { return s.bodies[1].applied.torque; });
  change_vector(changes, "proxy", [](State& s) -> glm::dvec3& { return s.proxies[5].position; });
  changes.push_back({"proxy.cell", [](State& s) { s.proxies[5].cell = 7; }});
  changes.push_back({"proxy.feature", [](State& s) { s.proxies[5].feature = 7; }});
  changes.push_back({"proxy.state", [](State& s) { s.proxies[5].state = ConstraintState::kVer; }});
  changes.push_back({"proxy.slipping", [](State& s) { s.proxies[5].slipping = true; }});
  changes.push_back({"proxy.swallowed", [](State& s) { s.proxies[5].swallowed = true; }});
  change_vector(changes, "contact_force", [](State& s) -> glm::dvec3& { return s.contact_forces[5]; });
  change_vector(changes, "hip_position", [](State& s) -> glm::dvec3& { return s.hip_positions[2]; });
  change_vector(changes, "hip_force", [](State& s) -> glm::dvec3& { return s.hip_forces[2]; });
  change_vector(changes, "wrench.force", [](State& s) -> glm::dvec3& { return s.finger_wrenches[1].force; });
  change_vector(changes, "wrench.torque",
                [](State& s) -> glm::dvec3& { return s.finger_wrenches[1].torque; });
  changes.push_back({"finger_started", [](State& s) { s.finger_started[1] = 1; }});
  return changes;
}

TEST(InitialState, HasOneOfEverythingAndTheScenesPoses) {
  const State state = initial_state(two_objects_three_hips());
  EXPECT_EQ(state.ticks, 0U);
  ASSERT_EQ(state.bodies.size(), 2U);
  EXPECT_EQ(state.bodies[1].world_from_object.position, glm::dvec3(1.0, 2.0, 3.0));
  EXPECT_EQ(state.proxies.size(), 6U);
  EXPECT_EQ(state.contact_forces.size(), 6U);
  EXPECT_EQ(state.hip_positions.size(), 3U);
  EXPECT_EQ(state.hip_forces.size(), 3U);
  EXPECT_EQ(state.finger_wrenches.size(), 2U);
  EXPECT_EQ(state.finger_started.size(), 2U);
}

TEST(StateHash, IsEqualForACopy) {
  State state = initial_state(two_objects_three_hips());
  for (const Change& change : every_change()) change.make(state);
  const State copy = state;
  EXPECT_EQ(hash(copy), hash(state));
}

TEST(StateHash, ChangesWithEveryField) {
  const State state = initial_state(two_objects_three_hips());
  std::vector<std::uint64_t> seen{hash(state)};
  for (const Change& change : every_change()) {
    State changed = state;
    change.make(changed);
    seen.push_back(hash(changed));
    for (std::size_t i = 0; i + 1 < seen.size(); ++i) EXPECT_NE(seen[i], seen.back()) << change.field;
  }
}

TEST(StateHash, TellsLastBitsAndSignedZerosApart) {
  State state = initial_state(two_objects_three_hips());
  const std::uint64_t before = hash(state);
  state.hip_forces[0].x = -0.0;
  EXPECT_NE(hash(state), before);
}

TEST(StateHash, IsFnv1aOfTheBytes) {
  // an empty state is 64 zero bytes, the tick and seven sizes: each only multiplies by the prime
  std::uint64_t expected = 14695981039346656037U;
  for (int i = 0; i < 64; ++i) expected *= 1099511628211U;
  EXPECT_EQ(hash(State{}), expected);
  // with tick 1, the first byte is 1
  expected = (14695981039346656037U ^ 1U);
  for (int i = 0; i < 64; ++i) expected *= 1099511628211U;
  State state;
  state.ticks = 1;
  EXPECT_EQ(hash(state), expected);
}

}  // namespace
}  // namespace haptic::engine
