#include "engine/portable_math.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

namespace haptic::engine {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(SinCos, AgreesWithTheLibraryOverManyTurns) {
  for (double angle = -400.0; angle < 400.0; angle += 0.00731) {
    const SinCos value = sin_cos(angle);
    ASSERT_NEAR(value.sine, std::sin(angle), 3e-16) << angle;
    ASSERT_NEAR(value.cosine, std::cos(angle), 3e-16) << angle;
  }
  for (double angle = 60000.0; angle < 60010.0; angle += 0.00731) {
    ASSERT_NEAR(sin_cos(angle).sine, std::sin(angle), 3e-16) << angle;
  }
}

TEST(SinCos, OfASmallAngleKeepsItsDigits) {
  EXPECT_EQ(sin_cos(1e-20).sine, 1e-20);
  EXPECT_EQ(sin_cos(0.0).sine, 0.0);
  EXPECT_EQ(sin_cos(0.0).cosine, 1.0);
}

TEST(SinCos, StaysOnTheUnitCircleWhateverTheAngle) {
  for (const double angle : {1e5, -1e9, 1e300, kInfinity, -kInfinity, kNan}) {
    const SinCos value = sin_cos(angle);
    EXPECT_NEAR(value.sine * value.sine + value.cosine * value.cosine, 1.0, 1e-15) << angle;
  }
}

TEST(RotationBy, TurnsByTheLengthAboutTheDirection) {
  // a quarter turn about z takes x to y
  const glm::dvec3 y = rotation_by({0.0, 0.0, std::numbers::pi / 2}) * glm::dvec3{1.0, 0.0, 0.0};
  EXPECT_NEAR(glm::distance(y, glm::dvec3(0.0, 1.0, 0.0)), 0.0, 1e-15);
  // about a general axis: the half angle in w, the axis in the vector part
  const glm::dvec3 axis = glm::normalize(glm::dvec3{1.0, -2.0, 0.5});
  const glm::dquat q = rotation_by(3.0 * axis);
  EXPECT_NEAR(q.w, std::cos(1.5), 1e-15);
  EXPECT_NEAR(glm::distance(glm::dvec3(q.x, q.y, q.z), std::sin(1.5) * axis), 0.0, 1e-15);
}

TEST(RotationBy, OfNothingIsExactlyTheIdentity) {
  EXPECT_EQ(rotation_by({0.0, 0.0, 0.0}), glm::dquat(1.0, 0.0, 0.0, 0.0));
}

TEST(RotationBy, GivesAUnitQuaternionWhateverTheVector) {
  for (const double length : {1e-300, 1e-160, 1e-8, 1.0, 1e3, 1e6, 1e100, 1e200, kInfinity, kNan}) {
    const glm::dquat q = rotation_by({0.6 * length, 0.0, -0.8 * length});
    EXPECT_NEAR(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z, 1.0, 1e-14) << length;
  }
}

TEST(Decay, AgreesWithTheExponential) {
  for (double a = 1e-12; a < 600.0; a *= 1.07) {
    const Decay left = decay(a);
    // each of up to eleven doublings adds a rounding and doubles the relative error
    ASSERT_NEAR(left.kept / std::exp(-a), 1.0, 1e-15 * (1.0 + 4.0 * a)) << a;
    ASSERT_NEAR(left.mean / (-std::expm1(-a) / a), 1.0, 2e-15) << a;
  }
}

TEST(Decay, OfNoTimeKeepsEverything) {
  EXPECT_EQ(decay(0.0).kept, 1.0);
  EXPECT_EQ(decay(0.0).mean, 1.0);
}

TEST(Decay, OfAnyLengthIsFinite) {
  for (const double a : {700.0, 1e4, 1e300, kInfinity}) {
    EXPECT_NEAR(decay(a).kept, 0.0, 1e-300);
    EXPECT_EQ(decay(a).mean, 1.0 / a);
  }
}

}  // namespace
}  // namespace haptic::engine
