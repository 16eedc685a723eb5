// The loop closed on a virtual clock: the emulated device presses a box of the engine, and what its motors do
// to the hand is the force of the contact, but for the steps of encoders and motor words.

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>

#include "tests/support/small_world.h"
#include "tests/unit/drivers/falcon/falcon_rig.h"

namespace haptic::drivers::falcon {
namespace {

constexpr double kCubeTop = 0.02;     // m, above the cube's middle
constexpr double kStiffness = 100.0;  // N/m, of the finger

// a count of one encoder moves the grip by at most 0.08 mm, and rounding by half of that in each of three
constexpr double kPositionStep = 1.5 * 0.08e-3;
// half a word at each of three motors, of at least 200 words a newton
constexpr double kForceStep = 3 * 0.5 / 200.0;

/// The device stands so that the middle of its workspace is over the cube, 20 mm above its surface.
class Press {
 public:
  /// One tick with the grip at `height` (m) over the cube's surface, `across` (m) along x.
  void tick(double height, double across) {
    rig.emulator.hold_at(kCentre + glm::dvec3(across, 0.0, height - 0.02));
    rig.exchange({.expires = rig.now + 3 * kMillisecond, .force = force});
    if (!rig.control.sample()) return;
    const glm::dvec3 position =
        rig.control.sample()->position - kCentre + glm::dvec3(0.0, 0.0, kCubeTop + 0.02);
    test::step(world, test::at(position));
    force = world.state().finger_wrenches[0].force;
  }

  FalconRig rig;
  engine::World world =
      test::world_of({test::cube(test::rigid(), false)}, {test::finger_of(engine::point_layout())});
  glm::dvec3 force{0.0};
};

TEST(FalconPress, TheHandFeelsStiffnessTimesDepth) {
  Press press;
  press.rig.settle_at(kCentre);
  for (int i = 0; i < 100; ++i) press.tick(0.01, 0.0);
  EXPECT_EQ(press.force, glm::dvec3(0.0)) << "nothing in the air";
  double height = 0.01;
  for (; height > -0.01; height -= 0.0001) press.tick(height, 0.0);
  for (int i = 0; i < 100; ++i) press.tick(-0.01, 0.0);
  const glm::dvec3 felt = press.rig.emulator.force();
  EXPECT_NEAR(felt.z, kStiffness * 0.01, kStiffness * kPositionStep + kForceStep);
  EXPECT_NEAR(glm::length(glm::dvec2(felt)), 0.0, kStiffness * kPositionStep + kForceStep);
}

TEST(FalconPress, AStrokeOverTheSurfaceIsFeltWithoutFriction) {
  Press press;
  press.rig.settle_at(kCentre);
  for (double height = 0.01; height > -0.005; height -= 0.0001) press.tick(height, 0.0);
  for (double across = 0.0; across < 0.015; across += 0.00005) {
    press.tick(-0.005, across);
    const glm::dvec3 felt = press.rig.emulator.force();
    ASSERT_NEAR(felt.z, kStiffness * 0.005, kStiffness * 2.0 * kPositionStep + kForceStep) << across;
    ASSERT_NEAR(felt.x, 0.0, kStiffness * kPositionStep + kForceStep) << across;
  }
  for (double height = -0.005; height < 0.01; height += 0.0001) press.tick(height, 0.015);
  EXPECT_EQ(press.rig.emulator.motors(), (std::array<int, 3>{})) << "let go";
}

}  // namespace
}  // namespace haptic::drivers::falcon
