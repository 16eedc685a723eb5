#include "drivers/polhem/polhem_kinematics.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

namespace haptic::drivers::polhem {
namespace {

const Model* const kModels[] = {&kWoodenhaptics2019, &kWoodenhaptics2015, &kAluhapticsV2, &kVintage};

// 6000 counts of 2000 a turn are 3 turns of the motor, a twelfth of that of the body: a quarter turn
TEST(PolhemKinematics, CountsTurnTheBodyThroughTheCapstan) {
  const glm::dvec3 angles = joint_angles(kWoodenhaptics2019, {2000, 0, 6000});
  EXPECT_NEAR(angles.x, 2.0 * std::numbers::pi / 16.0, 1e-15);
  EXPECT_EQ(angles.y, 0.0);
  EXPECT_NEAR(angles.z, std::numbers::pi / 2.0, 1e-15);
}

// B upright and C level: R = Lc = 0.245 m and z = Ln + Lb - z0 = 0.205 m
TEST(PolhemKinematics, TheRestPoseIsWhereTheLinksPutIt) {
  const glm::dvec3 tip = tip_position(kWoodenhaptics2019, joint_angles(kWoodenhaptics2019, {0, 0, 6000}));
  EXPECT_NEAR(glm::distance(tip, glm::dvec3(0.245 - 0.220, 0.0, 0.205)), 0.0, 1e-12);
}

// tau . dtheta = F . dP for every movement: what the motors give is what the hand gets.
TEST(PolhemKinematics, TorquesDoTheWorkOfTheForce) {
  const glm::dvec3 force(1.3, -0.7, 2.1);
  constexpr double kStep = 1e-6;
  for (const Model* model : kModels) {
    for (const glm::dvec3 angles :
         {glm::dvec3(0, 0, 1.57), glm::dvec3(0.5, 0.3, 1.2), glm::dvec3(-0.7, -0.4, 1.9)}) {
      const glm::dvec3 torques = joint_torques(*model, angles, force);
      for (int joint = 0; joint < 3; ++joint) {
        glm::dvec3 turn(0.0);
        turn[joint] = kStep;
        const glm::dvec3 way = tip_position(*model, angles + turn) - tip_position(*model, angles - turn);
        EXPECT_NEAR(torques[joint], glm::dot(force, way) / (2.0 * kStep), 1e-8);
      }
    }
  }
}

// 0.603 N m at the body are 0.05025 N m at the motor, which takes 0.8333 A at 0.0603 N m/A
TEST(PolhemKinematics, CurrentsAreTorquesThroughCapstanAndTorqueConstant) {
  EXPECT_EQ(motor_currents(kWoodenhaptics2019, {0.0, 0.603, -0.603}, 2.0), (Joints{0, 833, -833}));
}

TEST(PolhemKinematics, NoCurrentIsAboveTheLimitAndTheRatioStays) {
  EXPECT_EQ(motor_currents(kWoodenhaptics2019, {0.0, 6.03, -3.015}, 2.0), (Joints{0, 2000, -1000}));
  EXPECT_EQ(motor_currents(kWoodenhaptics2019, {0.0, 1e300, -5e299}, 2.0), (Joints{0, 2000, -1000}));
}

TEST(PolhemKinematics, ATorqueThatIsNoNumberAsksForNothing) {
  EXPECT_EQ(motor_currents(kVintage, {0.1, std::numeric_limits<double>::quiet_NaN(), 0.1}, 2.0), Joints{});
  EXPECT_EQ(motor_currents(kVintage, {0.1, 0.1, std::numeric_limits<double>::infinity()}, 2.0), Joints{});
}

}  // namespace
}  // namespace haptic::drivers::polhem
