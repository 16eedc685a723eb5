// Scenes that are edited while a hand holds them: what the device feels of it, and what the tick does for it.

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <numeric>

#include "engine/shapes.h"
#include "rt/allocation_guard.h"
#include "tests/support/servo_rig.h"

namespace haptic::servo {
namespace {

using engine::Index;
using engine::kNone;
using test::ServoRig;

const std::vector<std::string> kDevices = {"a"};

ServoSettings armed(double max_force_rate, double ramp = 0.0) {
  ServoSettings settings{.limits = test::wide_limits(), .armed_from_start = true};
  settings.limits.max_force_rate = max_force_rate;
  settings.limits.arm_ramp = ramp;
  return settings;
}

/// Swaps `after` in, as an edit of what runs now or will run when all that was sent before is done.
void swap_in(ServoRig& rig, const engine::Scene& before, std::uint64_t from_revision,
             const engine::Scene& after, const std::vector<Index>& objects) {
  std::vector<Index> fingers(after.fingers.size());
  std::iota(fingers.begin(), fingers.end(), Index{0});
  auto prepared = prepare_scene(std::make_shared<const engine::Scene>(after), from_revision + 1, kDevices);
  prepared->carry =
      Carry{.from_revision = from_revision, .map = make_carry_map(before, after, objects, fingers)};
  rig.mailbox().commands.push({.kind = CommandKind::kSwapScene, .request = 9, .scene = prepared.release()});
}

void edit(ServoRig& rig, const engine::Scene& after, const std::vector<Index>& objects) {
  swap_in(rig, rig.loop().scene().world.scene(), rig.loop().scene().revision, after, objects);
}

void free_events(ServoRig& rig) {
  for (const Event& event : rig.events()) delete event.scene;
}

/// From above the wall to 10 mm deep in it: 1 N wanted.
void press(ServoRig& rig) {
  rig.device(0).sample.position = {0.01, 0.02, 0.005};
  rig.tick();
  rig.device(0).sample.position.z = -0.01;
  rig.tick();
}

engine::Scene with_far_wall(const engine::Scene& scene) {
  engine::Scene after = scene;
  engine::Object far = scene.objects[0];
  far.initial_pose.position = {5.0, 0.0, 0.0};
  after.objects.insert(after.objects.begin(), far);
  return after;
}

TEST(SceneEdit, LeavesTheForceOfAnUntouchedContactToTheBit) {
  // in the middle of the ramp too
  ServoRig plain(armed(1e9, 0.1), kDevices);
  ServoRig edited(armed(1e9, 0.1), kDevices);
  press(plain);
  press(edited);
  for (int i = 0; i < 300; ++i) {
    if (i == 30 || i == 200) edit(edited, with_far_wall(edited.loop().scene().world.scene()), {kNone, 0});
    if (i == 100) {
      engine::Scene narrow = edited.loop().scene().world.scene();
      narrow.objects.erase(narrow.objects.begin());
      edit(edited, narrow, {1});
    }
    for (ServoRig* const rig : {&plain, &edited}) {
      rig->device(0).sample.position.z = -0.01 - 1e-5 * i;
      rig->device(0).sample.position.x = 0.01 + 1e-5 * i;
      rig->tick();
    }
    ASSERT_EQ(edited.device(0).written.force, plain.device(0).written.force) << i;
  }
  EXPECT_GT(edited.device(0).written.force.z, 1.0);
  EXPECT_EQ(edited.loop().scene().revision, 4u);
  free_events(edited);
}

TEST(SceneEdit, NeverMovesTheForceFasterThanTheGuardsRate) {
  constexpr double kRate = 100.0;  // N/s: 0.1 N in a tick
  ServoRig rig(armed(kRate), kDevices);
  press(rig);
  rig.tick(20);
  ASSERT_NEAR(rig.device(0).written.force.z, 1.0, 1e-9);
  const engine::Scene wall = rig.loop().scene().world.scene();
  engine::Scene none = wall;
  none.objects.clear();
  engine::Scene away = wall;
  away.objects[0].initial_pose.position.z = -0.005;  // the HIP is 5 mm in its solid

  glm::dvec3 last = rig.device(0).written.force;
  double largest = 0.0;
  const auto run = [&](double z) {
    rig.device(0).sample.position.z = z;
    for (int i = 0; i < 20; ++i) {
      rig.tick();
      largest = std::max(largest, glm::length(rig.device(0).written.force - last));
      last = rig.device(0).written.force;
    }
    free_events(rig);
  };
  edit(rig, none, {});
  run(-0.01);
  EXPECT_EQ(last, glm::dvec3(0.0)) << "a removed object's force vanishes";
  edit(rig, wall, {kNone});
  run(-0.01);
  EXPECT_EQ(last, glm::dvec3(0.0)) << "an object that appears around the HIP swallows it";
  run(0.005);
  run(-0.01);
  EXPECT_NEAR(last.z, 1.0, 1e-9);
  edit(rig, away, {kNone});
  run(-0.01);
  EXPECT_EQ(last, glm::dvec3(0.0)) << "so does one that is moved there";
  // at 1 N the limit acts
  EXPECT_NEAR(largest, kRate / 1000.0, 1e-12);
}

TEST(SceneEdit, OfASceneThatNoLongerRunsIsRefusedAndGivenBack) {
  ServoRig rig(armed(1e9), kDevices);
  press(rig);
  const engine::Scene scene = rig.loop().scene().world.scene();
  swap_in(rig, scene, 1, with_far_wall(scene), {kNone, 0});
  swap_in(rig, scene, 1, with_far_wall(scene), {kNone, 0});
  rig.tick();
  EXPECT_EQ(rig.loop().scene().revision, 2u);
  std::vector<EventKind> answers;
  for (const Event& event : rig.events()) {
    EXPECT_NE(event.scene, &rig.loop().scene());
    delete event.scene;
    if (event.kind != EventKind::kSceneRetired) answers.push_back(event.kind);
  }
  EXPECT_EQ(answers, (std::vector<EventKind>{EventKind::kDone, EventKind::kOutdated}));
}

TEST(SceneEdit, WorksWhilePaused) {
  ServoRig rig(armed(1e9), kDevices);
  press(rig);
  rig.send(CommandKind::kPause);
  rig.tick();
  const std::uint64_t ticks = rig.loop().scene().world.state().ticks;
  edit(rig, with_far_wall(rig.loop().scene().world.scene()), {kNone, 0});
  rig.tick(3);
  EXPECT_EQ(rig.loop().scene().world.state().ticks, ticks);
  rig.send(CommandKind::kResume);
  rig.tick();
  EXPECT_NEAR(rig.device(0).written.force.z, 1.0, 1e-9);
  free_events(rig);
}

/// About a million cells in two objects, neither of which is near the wall.
std::vector<engine::Object> million_cells() {
  const engine::TetraMesh sphere = engine::icosphere_mesh(0.05, 6, 0.02);
  const engine::TetraMesh grid = test::kuhn_grid({48, 48, 48}, glm::dvec3{-0.1}, glm::dvec3{0.1},
                                                 [](const glm::dvec3& p) { return p.x < 0.0 ? 1 : 0; });
  engine::Material solid;
  solid.yield_force = engine::kRigid;
  std::vector<engine::Object> objects;
  for (const engine::TetraMesh* const mesh : {&sphere, &grid}) {
    engine::Object& object = objects.emplace_back();
    object.cells = std::make_shared<const engine::CellComplex>(engine::CellComplex::build(*mesh));
    object.materials = {engine::Material{}, solid};
    object.initial_pose.position.x = static_cast<double>(objects.size());
  }
  return objects;
}

std::uint64_t transitions(ServoRig& rig) {
  std::uint64_t sum = 0;
  for (const auto& row : rig.loop().scene().world.transitions().count) {
    for (const std::uint64_t count : row) sum += count;
  }
  return sum;
}

TEST(SceneEdit, AMillionCellsComeAndGoWithoutWorkOrMemoryInTheTick) {
  ServoRig rig(armed(1e9), kDevices);
  press(rig);
  const engine::Scene wall = rig.loop().scene().world.scene();
  engine::Scene large = wall;
  for (engine::Object& object : million_cells()) large.objects.push_back(std::move(object));
  const std::size_t cells = large.objects[1].cells->cells().size() + large.objects[2].cells->cells().size();
  EXPECT_GT(cells, 900'000u);
  const std::weak_ptr<const engine::CellComplex> grid = large.objects[2].cells;

  swap_in(rig, wall, 1, large, {0, kNone, kNone});
  const std::uint64_t before = transitions(rig);
  {
    const rt::AllocationGuard watch;
    rig.tick();
  }
  EXPECT_EQ(rig.loop().scene().revision, 2u);
  // all that a tick touches of a scene is one proxy of each object: 1 HIP x 3 objects, and what the wall's
  // contact needs to find that nothing has changed
  EXPECT_LE(transitions(rig) - before, 6u);
  EXPECT_EQ(rig.loop().scene().world.state().proxies.size(), 3u);
  EXPECT_EQ(rig.loop().scene().world.state().bodies.size(), 3u);
  EXPECT_NEAR(rig.device(0).written.force.z, 1.0, 1e-9);

  // the same as a load, with the HIP in the solid half of the grid, which swallows it
  engine::Scene loaded = large;
  loaded.objects.erase(loaded.objects.begin());
  loaded.objects[1].initial_pose.position = {0.05, 0.0, 0.0};
  rig.mailbox().commands.push(
      {.kind = CommandKind::kSwapScene,
       .scene = prepare_scene(std::make_shared<const engine::Scene>(loaded), 3, kDevices).release()});
  {
    const rt::AllocationGuard watch;
    rig.tick(3);
  }
  EXPECT_TRUE(rig.loop().scene().world.state().proxies[1].swallowed);
  EXPECT_LE(transitions(rig), 6u);  // 2 objects, 3 ticks

  swap_in(rig, loaded, 3, wall, {kNone});
  large.objects.clear();
  loaded.objects.clear();
  {
    const rt::AllocationGuard watch;
    rig.tick();
  }
  EXPECT_EQ(rig.loop().scene().revision, 4u);
  EXPECT_FALSE(grid.expired()) << "the servo thread freed a scene";
  free_events(rig);
  EXPECT_TRUE(grid.expired());
}

}  // namespace
}  // namespace haptic::servo
