#include "drivers/phantom/phantom_kinematics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace haptic::drivers::phantom {
namespace {

constexpr Geometry kArms{.upper_arm = 0.2, .forearm = 0.15};
constexpr double kRightAngle = std::numbers::pi / 2.0;

TEST(PhantomKinematics, WithAllAnglesZeroTheFingerIsAtTheOrigin) {
  EXPECT_EQ(finger_position(kArms, glm::dvec3(0.0)), glm::dvec3(0.0));
}

// the upper arm straight up: the elbow at y = 0.15 + 0.2 above the origin and on the axis of the base, z =
// -0.2; the forearm hangs 0.15 below
TEST(PhantomKinematics, TheUpperArmLiftsTheElbow) {
  const glm::dvec3 at = finger_position(kArms, {0.0, kRightAngle, 0.0});
  EXPECT_NEAR(glm::length(at - glm::dvec3(0.0, 0.2, -0.2)), 0.0, 1e-15);
}

// level: the elbow is at (0, 0.15, 0), the finger 0.15 before it
TEST(PhantomKinematics, TheForearmSwingsTowardsTheUser) {
  const glm::dvec3 at = finger_position(kArms, {0.0, 0.0, kRightAngle});
  EXPECT_NEAR(glm::length(at - glm::dvec3(0.0, 0.15, 0.15)), 0.0, 1e-15);
}

// the axis stands 0.2 behind the origin; from it the finger turns to x = 0.2
TEST(PhantomKinematics, TheBaseTurnsToTheRight) {
  const glm::dvec3 at = finger_position(kArms, {kRightAngle, 0.0, 0.0});
  EXPECT_NEAR(glm::length(at - glm::dvec3(0.2, 0.0, -0.2)), 0.0, 1e-15);
}

// each force at the lever that it has: 1 N to the right 0.2 m from the base's axis; up, 0.2 m from the upper
// arm's; to the user, 0.15 m below the elbow
TEST(PhantomKinematics, TorquesAtTheOriginAreForceTimesLever) {
  const glm::dvec3 zero(0.0);
  EXPECT_NEAR(glm::length(joint_torques(kArms, zero, {1, 0, 0}) - glm::dvec3(0.2, 0.0, 0.0)), 0.0, 1e-15);
  EXPECT_NEAR(glm::length(joint_torques(kArms, zero, {0, 1, 0}) - glm::dvec3(0.0, 0.2, 0.0)), 0.0, 1e-15);
  EXPECT_NEAR(glm::length(joint_torques(kArms, zero, {0, 0, 1}) - glm::dvec3(0.0, 0.0, 0.15)), 0.0, 1e-15);
}

// virtual work: for any small motion, torque times angle is force times way
TEST(PhantomKinematics, TorquesDoTheWorkOfTheForce) {
  constexpr double kStep = 1e-6;
  const glm::dvec3 force(0.7, -1.1, 0.4);
  for (const double base : {-0.9, 0.3}) {
    for (const double upper : {-0.6, 0.8}) {
      for (const double fore : {-0.5, 1.1}) {
        const glm::dvec3 angles(base, upper, fore);
        const glm::dvec3 torques = joint_torques(kArms, angles, force);
        for (glm::length_t axis = 0; axis < 3; ++axis) {
          glm::dvec3 step(0.0);
          step[axis] = kStep;
          const glm::dvec3 way =
              (finger_position(kArms, angles + step) - finger_position(kArms, angles - step)) / (2.0 * kStep);
          // the difference quotient is off by the third derivative, 0.35 m * kStep^2, and rounding of 1e-17 /
          // kStep
          EXPECT_NEAR(torques[axis], glm::dot(force, way), 1e-9);
        }
      }
    }
  }
}

}  // namespace
}  // namespace haptic::drivers::phantom
