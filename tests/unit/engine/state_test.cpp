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

// what `xxhsum -H1` says of the same rows of four words, written to a file from the lowest byte up
TEST(StateHash, IsXxh64OfItsRows) {
  // 0 0 0 0 | 0 0 0 0
  State state;
  EXPECT_EQ(hash(state), 0x257b09a147b82a19U);
  // 1 0 0 0 | 0 0 0 0
  state.ticks = 1;
  EXPECT_EQ(hash(state), 0x0e013aef6a0d56a0U);
  // 3 1 1 1 | 1 1 1 1 | 1. 2. 3. 0.5 | 0.5 0.5 -0.5 4. | 5. 6. 7. 8. | 9. 10. 11. 12. | 13. 14. 15. 0 |
  // 0.1 0.2 0.3 17+19*2^32 | 0.4 0.5 0.6 0x301 | -1. -2. -3. 0 | 0.25 -0. 1e300 0 | 21. 22. 23. 1
  // | 24. 25. 26. 0
  state.ticks = 3;
  state.bodies.push_back({.world_from_object = {{1, 2, 3}, {0.5, 0.5, 0.5, -0.5}},
                          .velocity = {4, 5, 6},
                          .angular_momentum = {7, 8, 9},
                          .applied = {{10, 11, 12}, {13, 14, 15}}});
  state.proxies.push_back({.position = {0.1, 0.2, 0.3},
                           .cell = 17,
                           .feature = 19,
                           .state = ConstraintState::kSur,
                           .slipping = true,
                           .swallowed = true});
  state.contact_forces.push_back({0.4, 0.5, 0.6});
  state.hip_positions.push_back({-1, -2, -3});
  state.hip_forces.push_back({0.25, -0.0, 1e300});
  state.finger_wrenches.push_back({{21, 22, 23}, {24, 25, 26}});
  state.finger_started.push_back(1);
  EXPECT_EQ(hash(state), 0xeac4626e35657806U);
}

}  // namespace
}  // namespace haptic::engine
