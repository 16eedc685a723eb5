#include "engine/pose.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

namespace haptic::engine {
namespace {

// a quarter turn about z, then a shift
Pose quarter_turn() {
  const double half = std::sqrt(0.5);
  return {{1.0, 2.0, 3.0}, {half, 0.0, 0.0, half}};
}

void expect_near(const glm::dvec3& a, const glm::dvec3& b, double tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

TEST(Pose, RotatesThenShifts) {
  // a right-handed quarter turn about z takes x to y and y to -x
  expect_near(quarter_turn() * glm::dvec3{1.0, 0.0, 0.0}, {1.0, 3.0, 3.0}, 1e-15);
  expect_near(quarter_turn() * glm::dvec3{0.0, 1.0, 0.0}, {0.0, 2.0, 3.0}, 1e-15);
  expect_near(quarter_turn() * glm::dvec3{0.0, 0.0, 1.0}, {1.0, 2.0, 4.0}, 1e-15);
}

TEST(Pose, OfNothingIsTheIdentity) {
  const glm::dvec3 p{0.1, -0.2, 0.3};
  EXPECT_EQ(Pose{} * p, p);
}

TEST(Pose, ProductTakesAPointThroughBothFrames) {
  const Pose a_from_b = quarter_turn();
  const Pose b_from_c{{-0.5, 0.25, 4.0}, glm::normalize(glm::dquat{0.3, -0.4, 0.5, 0.6})};
  const glm::dvec3 p_c{0.7, 0.8, -0.9};
  expect_near((a_from_b * b_from_c) * p_c, a_from_b * (b_from_c * p_c), 1e-14);
}

TEST(Pose, InverseTakesAPointBack) {
  const Pose pose{{-0.5, 0.25, 4.0}, glm::normalize(glm::dquat{0.3, -0.4, 0.5, 0.6})};
  const glm::dvec3 p{0.7, 0.8, -0.9};
  expect_near(inverse(pose) * (pose * p), p, 1e-14);
  expect_near(pose * (inverse(pose) * p), p, 1e-14);
}

}  // namespace
}  // namespace haptic::engine
