#pragma once
// Comparing vectors in tests.

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace haptic::test {

inline ::testing::AssertionResult near(const glm::dvec3& actual, const glm::dvec3& expected,
                                       double tolerance) {
  const double distance = glm::distance(actual, expected);
  if (distance <= tolerance) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure()
         << "(" << actual.x << ", " << actual.y << ", " << actual.z << ") is " << distance << " from ("
         << expected.x << ", " << expected.y << ", " << expected.z << ")";
}

}  // namespace haptic::test
