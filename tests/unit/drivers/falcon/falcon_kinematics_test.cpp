// The table of positions, angles and motor words was computed apart from this code and checked against
// central differences of the geometry.

#include "drivers/falcon/falcon_kinematics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <numbers>

namespace haptic::drivers::falcon {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kGain = 10000.0;

struct Row {
  Words counts;
  glm::dvec3 degrees;
  glm::dvec3 millimetres;
  glm::dvec3 words[3];  // for 1 N along x, y, z
};

const Row kTable[] = {
    {{0, 0, 0},
     {35, 35, 35},
     {0, 0, 134.6024},
     {{-193.0, 650.8, -457.7}, {640.0, -152.8, -487.2}, {-249.4, -249.4, -249.4}}},
    {{-300, -300, -300},
     {24.0696, 24.0696, 24.0696},
     {0, 0, 120.1992},
     {{-171.4, 581.9, -410.4}, {572.9, -138.0, -434.9}, {-251.1, -251.1, -251.1}}},
    {{-500, -500, -500},
     {16.7827, 16.7827, 16.7827},
     {0, 0, 110.7545},
     {{-156.1, 531.4, -375.3}, {523.5, -126.5, -397.0}, {-242.8, -242.8, -242.8}}},
    {{300, 300, 300},
     {45.9304, 45.9304, 45.9304},
     {0, 0, 148.4236},
     {{-211.0, 703.7, -492.8}, {690.8, -162.7, -528.1}, {-230.9, -230.9, -230.9}}},
    {{-600, 0, 300},
     {13.1392, 35, 45.9304},
     {2.8881, 30.9701, 125.0893},
     {{-150.7, 649.3, -525.2}, {477.9, -131.6, -509.6}, {-402.0, -227.9, -86.2}}},
    {{200, -700, -100},
     {42.2869, 9.4957, 31.3565},
     {24.5337, -17.3038, 120.5366},
     {{-178.3, 470.6, -429.0}, {682.4, -101.5, -471.2}, {-95.3, -393.3, -226.2}}},
};

/// Every 5 mm in a box of +-30 mm by 95 to 155 mm.
template <class Visit>
void everywhere(const Visit& visit) {
  for (int x = -6; x <= 6; ++x) {
    for (int y = -6; y <= 6; ++y) {
      for (int z = 19; z <= 31; ++z) visit(glm::dvec3(x, y, z) * 0.005);
    }
  }
}

TEST(FalconKinematics, CountsAreAnglesOfTheThighs) {
  for (const Row& row : kTable) {
    const glm::dvec3 degrees = thigh_angles(row.counts) / kDegree;
    EXPECT_NEAR(glm::distance(degrees, row.degrees), 0.0, 1e-4);
    EXPECT_EQ(counts_of(thigh_angles(row.counts)), row.counts);
  }
}

TEST(FalconKinematics, PositionsAreThoseOfTheTable) {
  for (const Row& row : kTable) {
    const auto position = forward_kinematics(thigh_angles(row.counts), kCentre);
    ASSERT_TRUE(position);
    EXPECT_NEAR(glm::distance(*position * 1000.0, row.millimetres), 0.0, 1.5e-4);
  }
}

TEST(FalconKinematics, AnglesOnTheAxisAreThoseOfTheTable) {
  const auto at_110 = leg_angles({0.0, 0.0, 0.110}, 0);
  ASSERT_TRUE(at_110);
  EXPECT_NEAR(at_110->thigh / kDegree, 16.1880, 1e-4);
  EXPECT_NEAR(at_110->shin / kDegree, 131.7302, 1e-4);
  EXPECT_NEAR(at_110->twist / kDegree, 91.0677, 1e-4);
  const auto at_125 = leg_angles({0.0, 0.0, 0.125}, 2);
  ASSERT_TRUE(at_125);
  EXPECT_NEAR(at_125->thigh / kDegree, 27.7093, 1e-4);
  EXPECT_NEAR(at_125->shin / kDegree, 129.0208, 1e-4);
}

TEST(FalconKinematics, TheJacobianIsTheDerivativeOfTheAngles) {
  constexpr double kStep = 1e-5;
  everywhere([](const glm::dvec3& position) {
    const auto rows = transposed_jacobian(position);
    ASSERT_TRUE(rows);
    for (int axis = 0; axis < 3; ++axis) {
      glm::dvec3 step(0.0);
      step[axis] = kStep;
      const auto after = inverse_kinematics(position + step);
      const auto before = inverse_kinematics(position - step);
      ASSERT_TRUE(after && before);
      const glm::dvec3 slope = (*after - *before) / (2.0 * kStep);
      for (int leg = 0; leg < 3; ++leg)
        EXPECT_NEAR((*rows)[leg][axis], slope[leg], 1e-4);  // of some 20 rad/m
    }
  });
}

TEST(FalconKinematics, ForwardUndoesInverseFromAColdStart) {
  everywhere([](const glm::dvec3& position) {
    const auto thighs = inverse_kinematics(position);
    ASSERT_TRUE(thighs);
    const auto found = forward_kinematics(*thighs, kCentre);
    ASSERT_TRUE(found) << position.x << " " << position.y << " " << position.z;
    EXPECT_NEAR(glm::distance(*found, position), 0.0, 1e-9);
  });
}

TEST(FalconKinematics, ForwardFollowsAStrokeToTheEdgeOfTheWorkspaceAndBack) {
  glm::dvec3 last = kCentre;
  for (int i = 0; i <= 2000; ++i) {
    const double t = i * 1e-3;
    const glm::dvec3 position(0.045 * std::sin(3.0 * t), 0.045 * std::sin(4.1 * t),
                              0.125 + 0.03 * std::sin(5.3 * t));
    const auto thighs = inverse_kinematics(position);
    if (!thighs) continue;
    const auto found = forward_kinematics(*thighs, last);
    ASSERT_TRUE(found) << i;
    ASSERT_NEAR(glm::distance(*found, position), 0.0, 1e-9) << i;
    last = *found;
  }
}

TEST(FalconKinematics, AnglesThatNoPlaceHasAreRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(forward_kinematics({nan, 0.5, 0.5}, kCentre));
  EXPECT_FALSE(forward_kinematics({0.5, 0.5, 0.5}, {nan, 0.0, 0.1}));
  // one thigh folded in, two stretched out: the legs do not meet
  EXPECT_FALSE(forward_kinematics({-1.4, 1.9, 1.9}, kCentre));
}

TEST(FalconKinematics, PlacesOutOfReachAreRefused) {
  EXPECT_FALSE(inverse_kinematics({0.0, 0.0, 0.3}));
  EXPECT_FALSE(inverse_kinematics({0.2, 0.0, 0.12}));
  EXPECT_FALSE(joint_torques({0.0, 0.0, 0.3}, {1.0, 0.0, 0.0}));
}

TEST(FalconKinematics, OneNewtonAsksForTheWordsOfTheTable) {
  for (const Row& row : kTable) {
    const auto position = forward_kinematics(thigh_angles(row.counts), kCentre);
    ASSERT_TRUE(position);
    for (int axis = 0; axis < 3; ++axis) {
      glm::dvec3 force(0.0);
      force[axis] = 1.0;
      const auto torques = joint_torques(*position, force);
      ASSERT_TRUE(torques);
      for (int leg = 0; leg < 3; ++leg) EXPECT_NEAR(-kGain * (*torques)[leg], row.words[axis][leg], 0.06);
    }
  }
}

// tau . dtheta = F . dP for every movement dP: what the motors give is what the hand gets.
TEST(FalconKinematics, TorquesDoTheWorkOfTheForce) {
  const glm::dvec3 force(1.3, -0.7, 2.1);
  everywhere([&](const glm::dvec3& position) {
    const auto torques = joint_torques(position, force);
    ASSERT_TRUE(torques);
    for (const glm::dvec3 step : {glm::dvec3(1e-5, 0, 0), glm::dvec3(0, 1e-5, 0), glm::dvec3(0, 0, 1e-5)}) {
      const glm::dvec3 turn = *inverse_kinematics(position + step) - *inverse_kinematics(position - step);
      EXPECT_NEAR(glm::dot(*torques, turn), glm::dot(force, 2.0 * step), 1e-9);
    }
  });
}

TEST(FalconKinematics, SaturationKeepsTheDirectionOfTheTorques) {
  const glm::dvec3 torques(0.3, -0.9, 0.15);                           // -9000 in the middle
  EXPECT_EQ(motor_words(torques, kGain), (Words{-1365, 4095, -683}));  // all by 4095/9000: 682.5 rounds away
  EXPECT_EQ(motor_words(torques * 1e6, kGain), (Words{-1365, 4095, -683}));
  EXPECT_EQ(motor_words({0.1, 0.2, -0.40949}, kGain), (Words{-1000, -2000, 4095})) << "just within";
}

TEST(FalconKinematics, ATorqueThatIsNoNumberAsksForNothing) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(motor_words({nan, 0.1, 0.1}, kGain), Words{});
  EXPECT_EQ(motor_words({0.1, infinity, 0.1}, kGain), Words{});
  EXPECT_EQ(motor_words({0.1, 0.1, 0.1}, nan), Words{});
}

}  // namespace
}  // namespace haptic::drivers::falcon
