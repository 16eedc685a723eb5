#include "engine/finger.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

#include "engine/constants.h"
#include "engine/scene.h"

namespace haptic::engine {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

void expect_near(const glm::dvec3& a, const glm::dvec3& b, double tolerance) {
  EXPECT_NEAR(glm::distance(a, b), 0.0, tolerance) << a.x << ' ' << a.y << ' ' << a.z;
}

TEST(PointLayout, IsOneHipAtTheOrigin) {
  ASSERT_EQ(point_layout().size(), 1U);
  EXPECT_EQ(point_layout()[0], glm::dvec3(0.0));
}

TEST(LineLayout, SpreadsHipsEvenlyAndReachesBothEnds) {
  const glm::dvec3 start{-0.0245, 0.01, 0.3};
  const glm::dvec3 end{0.0245, 0.03, 0.1};
  const auto points = line_layout(start, end, 50);
  ASSERT_EQ(points.size(), 50U);
  EXPECT_EQ(points.front(), start);
  EXPECT_EQ(points.back(), end);
  for (std::size_t i = 1; i < points.size(); ++i) {
    expect_near(points[i] - points[i - 1], (end - start) / 49.0, 1e-16);
  }
}

TEST(LineLayout, PutsASingleHipInTheMiddle) {
  const auto points = line_layout({0.0, 0.0, 0.0}, {0.2, 0.4, -0.6}, 1);
  ASSERT_EQ(points.size(), 1U);
  expect_near(points[0], {0.1, 0.2, -0.3}, 1e-16);
}

TEST(FingertipLayout, HasItsFirstHipAtThePole) {
  for (const glm::dvec3 direction : {glm::dvec3{0, 0, 1}, glm::dvec3{0, 0, -1}, glm::dvec3{1, 0, 0},
                                     glm::dvec3{0, -1, 0}, glm::dvec3{1, -2, 3}}) {
    for (const int hips : {1, 2, 11}) {
      const auto points = fingertip_layout(0.008, 0.5, hips, direction);
      ASSERT_EQ(points.size(), static_cast<std::size_t>(hips));
      expect_near(points[0], 0.008 * glm::normalize(direction), 1e-17);
    }
  }
}

TEST(FingertipLayout, LiesOnTheCap) {
  const glm::dvec3 direction = glm::normalize(glm::dvec3{1.0, -2.0, 3.0});
  for (const auto& p : fingertip_layout(0.008, 0.5, 100, direction)) {
    EXPECT_NEAR(glm::length(p), 0.008, 1e-17);
    EXPECT_GE(glm::dot(p, direction), 0.008 * std::cos(0.5));
  }
}

TEST(FingertipLayout, GivesEachHipAnEqualArea) {
  // the area of a cap is as its height (Archimedes): within a fraction f of the height there are f of the
  // HIPs
  constexpr int kHips = 200;
  const auto points = fingertip_layout(1.0, 1.2, kHips, {0.0, 0.0, 1.0});
  const double height = 1.0 - std::cos(1.2);
  for (const double fraction : {0.1, 0.25, 0.5, 0.9, 1.0}) {
    int within = 0;
    for (const auto& p : points) within += 1.0 - p.z <= fraction * height ? 1 : 0;
    EXPECT_NEAR(within, fraction * kHips, 1.0) << fraction;
  }
  // and around the pole they balance: a lopsided fingertip would roll
  glm::dvec3 sum{0.0};
  for (const auto& p : points) sum += p;
  EXPECT_LT(std::hypot(sum.x, sum.y) / kHips, 0.01);
}

TEST(FingertipLayout, CoversAWholeSphere) {
  glm::dvec3 sum{0.0};
  for (const auto& p : fingertip_layout(1.0, std::numbers::pi, 500, {0.0, 1.0, 0.0})) sum += p;
  EXPECT_LT(glm::length(sum) / 500.0, 0.005);
}

TEST(FingertipLayout, KeepsHipsApart) {
  // a hexagonal lattice of n points on the area 2 pi r^2 (1 - cos a) has spacing^2 = area / n * 2 / sqrt 3;
  // the spiral keeps well over half of that, also next to the pole
  const double area = 2.0 * std::numbers::pi * 0.008 * 0.008 * (1.0 - std::cos(0.5));
  const double hexagonal = std::sqrt(area / 11.0 * 2.0 / std::sqrt(3.0));
  const auto points = fingertip_layout(0.008, 0.5, 11, {0.0, 0.0, 1.0});
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) EXPECT_GT(glm::distance(points[i], points[j]), 0.6 * hexagonal);
  }
}

TEST(FingertipLayout, TouchesAPlaneWithEveryHipWhenPressedOneMillimetre) {
  // the cap of 8 mm and 0.5 rad is 8 (1 - cos 0.5) = 0.98 mm high
  for (const auto& p : fingertip_layout(0.008, 0.5, 11, {0.0, 0.0, 1.0})) EXPECT_GT(p.z, 0.008 - 0.001);
}

TEST(FingertipLayout, OfTheOppositeDirectionIsItsMirrorImage) {
  for (const glm::dvec3 direction : {glm::dvec3{0, 0, 1}, glm::dvec3{0, 1, 0}, glm::dvec3{1, 0, 0},
                                     glm::dvec3{0, -1, 2}, glm::dvec3{1, -2, 3}}) {
    const auto points = fingertip_layout(0.008, 0.5, 11, direction);
    const auto facing = fingertip_layout(0.008, 0.5, 11, -direction);
    const glm::dvec3 pole = glm::normalize(direction);
    for (std::size_t i = 0; i < points.size(); ++i) {
      expect_near(facing[i], points[i] - 2.0 * glm::dot(points[i], pole) * pole, 1e-17);
    }
  }
}

TEST(FingertipLayout, AsksOnlyTheDirectionOfItsDirection) {
  const auto unit = fingertip_layout(0.008, 0.5, 11, {0.0, 0.0, 1.0});
  for (const double length : {1e-200, 1e-3, 4.0, 1e200}) {
    const auto scaled = fingertip_layout(0.008, 0.5, 11, {0.0, 0.0, length});
    for (std::size_t i = 0; i < unit.size(); ++i) EXPECT_EQ(scaled[i], unit[i]);
  }
}

TEST(SumWrench, OfACoupleIsPureTorqueAboutTheNormal) {
  const glm::dvec3 origin{1.0, 2.0, 3.0};
  const std::array positions{origin + glm::dvec3{0.01, 0.0, 0.005}, origin + glm::dvec3{-0.01, 0.0, 0.005}};
  const std::array forces{glm::dvec3{0.0, 2.0, 0.0}, glm::dvec3{0.0, -2.0, 0.0}};
  const Wrench wrench = sum_wrench(positions, forces, origin);
  EXPECT_EQ(wrench.force, glm::dvec3(0.0));
  // two arms of 10 mm with 2 N each
  expect_near(wrench.torque, {0.0, 0.0, 0.04}, 1e-16);
}

TEST(SumWrench, OfOneForceIsTheForceWithItsMoment) {
  const std::array positions{glm::dvec3{0.1, 0.0, 0.0}};
  const std::array forces{glm::dvec3{0.0, 0.0, 3.0}};
  const Wrench wrench = sum_wrench(positions, forces, {0.0, 0.0, 0.0});
  EXPECT_EQ(wrench.force, forces[0]);
  expect_near(wrench.torque, {0.0, -0.3, 0.0}, 1e-16);  // x cross z = -y
}

FingerPose pose_of(const glm::dvec3& position, const glm::dquat& orientation) {
  return {{position, orientation}, true};
}

TEST(FingerPose, IsUsableOnlyIfItCanBeMeant) {
  const glm::dquat upright{1.0, 0.0, 0.0, 0.0};
  EXPECT_TRUE(is_usable(pose_of({0.1, 0.2, 0.3}, upright)));
  EXPECT_TRUE(is_usable(pose_of({0.1, 0.2, 0.3}, {0.70710677F, 0.0, 0.70710677F, 0.0})));
  FingerPose absent = pose_of({0.1, 0.2, 0.3}, upright);
  absent.present = false;
  EXPECT_FALSE(is_usable(absent));
  for (const double bad : {kNan, kInfinity, -kInfinity, 2.0 * kWorldReach, -1e300}) {
    for (int axis = 0; axis < 3; ++axis) {
      glm::dvec3 position{0.0};
      position[axis] = bad;
      EXPECT_FALSE(is_usable(pose_of(position, upright))) << bad;
    }
    EXPECT_FALSE(is_usable(pose_of({0.0, 0.0, 0.0}, {1.0, bad, 0.0, 0.0}))) << bad;
  }
  EXPECT_FALSE(is_usable(pose_of({0.0, 0.0, 0.0}, {0.0, 0.0, 0.0, 0.0})));
  EXPECT_FALSE(is_usable(pose_of({0.0, 0.0, 0.0}, {2.0, 0.0, 0.0, 0.0})));
}

TEST(NumberHips, CountsThroughAllFingers) {
  Scene scene;
  scene.fingers.resize(3);
  scene.fingers[0].hips.resize(11);
  scene.fingers[2].hips.resize(4);
  number_hips(scene);
  EXPECT_EQ(scene.fingers[0].first_hip, 0U);
  EXPECT_EQ(scene.fingers[1].first_hip, 11U);
  EXPECT_EQ(scene.fingers[2].first_hip, 11U);
  EXPECT_EQ(scene.hip_count, 15U);
}

}  // namespace
}  // namespace haptic::engine
