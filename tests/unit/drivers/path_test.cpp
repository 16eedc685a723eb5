#include "drivers/path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace haptic::drivers {
namespace {

// 2 m along x in the first two seconds, then 1 m along y in the next one
const std::vector<PathPoint> kCorner = {
    {1.0, {0.0, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}},
    {3.0, {2.0, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}},
    {4.0, {2.0, 1.0, 0.0}, {1.0, 0.0, 0.0, 0.0}},
};

TEST(Path, IsStraightBetweenRows) {
  EXPECT_EQ(sample(kCorner, 1.5, false).position, glm::dvec3(0.5, 0.0, 0.0));
  EXPECT_EQ(sample(kCorner, 3.25, false).position, glm::dvec3(2.0, 0.25, 0.0));
}

TEST(Path, VelocityIsTheSlopeOfTheIntervalThatBegins) {
  EXPECT_EQ(sample(kCorner, 1.0, false).velocity, glm::dvec3(1.0, 0.0, 0.0));
  EXPECT_EQ(sample(kCorner, 2.9, false).velocity, glm::dvec3(1.0, 0.0, 0.0));
  EXPECT_EQ(sample(kCorner, 3.0, false).velocity, glm::dvec3(0.0, 1.0, 0.0));
}

TEST(Path, HoldsBothEndsAtRest) {
  for (const double before : {-1e9, 0.0, 0.999, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_EQ(sample(kCorner, before, false).position, kCorner.front().position);
    EXPECT_EQ(sample(kCorner, before, false).velocity, glm::dvec3(0.0));
  }
  for (const double after : {4.0, 5.0, 1e300}) {
    EXPECT_EQ(sample(kCorner, after, false).position, kCorner.back().position);
    EXPECT_EQ(sample(kCorner, after, false).velocity, glm::dvec3(0.0));
  }
}

TEST(Path, StartsAgainAtItsEndWhenRepeated) {
  EXPECT_EQ(sample(kCorner, 0.5, true).position,
            kCorner.front().position);  // before it starts it still holds
  EXPECT_EQ(sample(kCorner, 4.0, true).position, kCorner.front().position);
  // the period is 3 s: 11.25 s is 1.25 + 3 * 3 + 1 s, the same as 2.25 s
  EXPECT_EQ(sample(kCorner, 11.25, true).position, sample(kCorner, 2.25, false).position);
}

TEST(Path, OfOneRowHoldsForEver) {
  const std::vector<PathPoint> one = {{2.0, {1.0, 2.0, 3.0}, {1.0, 0.0, 0.0, 0.0}}};
  for (const double time : {-1.0, 2.0, 7.0}) {
    EXPECT_EQ(sample(one, time, true).position, glm::dvec3(1.0, 2.0, 3.0));
  }
}

TEST(Path, WithoutRowsRestsAtTheOrigin) {
  EXPECT_EQ(sample({}, 1.0, true).position, glm::dvec3(0.0));
  EXPECT_EQ(sample({}, 1.0, true).orientation, glm::dquat(1.0, 0.0, 0.0, 0.0));
}

TEST(Path, TurnsEvenlyAlongTheShorterArc) {
  // a quarter turn about z, its end written with the opposite sign: the same rotation
  const double half = std::sqrt(0.5);
  const std::vector<PathPoint> turn = {{0.0, {}, {1.0, 0.0, 0.0, 0.0}}, {1.0, {}, {-half, 0.0, 0.0, -half}}};
  const glm::dvec3 x = sample(turn, 1.0 / 3.0, false).orientation * glm::dvec3(1.0, 0.0, 0.0);
  const double thirty_degrees = std::acos(-1.0) / 6.0;
  EXPECT_NEAR(x.x, std::cos(thirty_degrees), 1e-15);
  EXPECT_NEAR(x.y, std::sin(thirty_degrees), 1e-15);
}

}  // namespace
}  // namespace haptic::drivers
