#include "drivers/haply/haply_kinematics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace haptic::drivers::haply {
namespace {

constexpr double kPi = std::numbers::pi;

// The elbows stand 0.019 + 0.07 cos 72 deg to each side of the middle, and the rods meet above them.
TEST(HaplyKinematics, TheHandleIsAboveTheMiddleOfSymmetricArms) {
  const auto handle = handle_position(kGeometry3, {kPi * 0.6, kPi * 0.4});
  ASSERT_TRUE(handle);
  const double half = 0.019 + 0.07 * std::cos(kPi * 0.4);
  EXPECT_NEAR(handle->x, 0.019, 1e-12);
  EXPECT_NEAR(handle->y, 0.07 * std::sin(kPi * 0.4) + std::sqrt(0.09 * 0.09 - half * half), 1e-12);
}

TEST(HaplyKinematics, BothRodsKeepTheirLength) {
  for (double t1 = 1.6; t1 < 2.6; t1 += 0.2) {
    for (double t2 = 0.5; t2 < 1.5; t2 += 0.2) {
      const auto handle = handle_position(kGeometry3, {t1, t2});
      ASSERT_TRUE(handle);
      const glm::dvec2 a = 0.07 * glm::dvec2(std::cos(t1), std::sin(t1));
      const glm::dvec2 b = glm::dvec2(0.038, 0.0) + 0.07 * glm::dvec2(std::cos(t2), std::sin(t2));
      EXPECT_NEAR(glm::distance(*handle, a), 0.09, 1e-12);
      EXPECT_NEAR(glm::distance(*handle, b), 0.09, 1e-12);
    }
  }
}

// tau . dt = F . dP for every movement: what the motors give is what the hand gets.
TEST(HaplyKinematics, TorquesDoTheWorkOfTheForce) {
  const glm::dvec2 force(0.8, -1.3);
  constexpr double kStep = 1e-6;
  for (const Geometry& geometry : {kGeometry2, kGeometry3}) {
    for (double t1 = 1.7; t1 < 2.5; t1 += 0.2) {
      for (double t2 = 0.6; t2 < 1.4; t2 += 0.2) {
        const auto torques = arm_torques(geometry, {t1, t2}, force);
        ASSERT_TRUE(torques);
        const glm::dvec2 way1 =
            *handle_position(geometry, {t1 + kStep, t2}) - *handle_position(geometry, {t1 - kStep, t2});
        const glm::dvec2 way2 =
            *handle_position(geometry, {t1, t2 + kStep}) - *handle_position(geometry, {t1, t2 - kStep});
        EXPECT_NEAR((*torques)[0], glm::dot(force, way1) / (2.0 * kStep), 1e-7);
        EXPECT_NEAR((*torques)[1], glm::dot(force, way2) / (2.0 * kStep), 1e-7);
      }
    }
  }
}

TEST(HaplyKinematics, WhereRodsLieInALineThereIsNeitherPlaceNorTorque) {
  // 178 mm between the elbows, and two rods of 89.05 mm
  EXPECT_FALSE(handle_position({0.07, 0.08905, 0.038}, {kPi, 0.0}));
  EXPECT_FALSE(handle_position(kGeometry2, {1.0, 1.0})) << "arms on one another";
  EXPECT_FALSE(arm_torques(kGeometry2, {1.0, 1.0}, {1.0, 0.0}));
  EXPECT_FALSE(handle_position(kGeometry3, {std::nan(""), 0.5}));
}

}  // namespace
}  // namespace haptic::drivers::haply
