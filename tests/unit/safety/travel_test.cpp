#include "safety/travel.h"

#include <gtest/gtest.h>

namespace haptic::safety {
namespace {

constexpr TravelBox kBox{{-0.1, -0.1, 0.05}, {0.1, 0.1, 0.2}};

TEST(Travel, TheSidesBelongToTheBox) {
  EXPECT_FALSE(over_travel(kBox, {-0.1, 0.1, 0.05}));
  EXPECT_FALSE(over_travel(kBox, {0.1, -0.1, 0.2}));
}

TEST(Travel, TellsTheCoordinateAndTheSideItIsBeyond) {
  const auto above = over_travel(kBox, {0.0, 0.0, 0.21});
  ASSERT_TRUE(above);
  EXPECT_EQ(above->coordinate, 0.21);
  EXPECT_EQ(above->side, 0.2);
  const auto below = over_travel(kBox, {0.0, -0.15, 0.1});
  ASSERT_TRUE(below);
  EXPECT_EQ(below->coordinate, -0.15);
  EXPECT_EQ(below->side, -0.1);
}

TEST(Travel, OfSeveralTheOneThatIsFurthestBeyond) {
  const auto worst = over_travel(kBox, {0.12, 0.0, 0.0});  // 20 mm and 50 mm
  ASSERT_TRUE(worst);
  EXPECT_EQ(worst->coordinate, 0.0);
  EXPECT_EQ(worst->side, 0.05);
}

TEST(Travel, ThereIsNoBoxByDefault) { EXPECT_FALSE(over_travel(TravelBox(), {1e300, -1e300, 0.0})); }

TEST(Travel, OfTwoBoxesBothHold) {
  const TravelBox both = intersection(kBox, {{-1.0, -0.05, -1.0}, {0.05, 1.0, 1.0}});
  EXPECT_EQ(both.min, glm::dvec3(-0.1, -0.05, 0.05));
  EXPECT_EQ(both.max, glm::dvec3(0.05, 0.1, 0.2));
}

TEST(Travel, BeyondBoxesThatHaveNothingInCommonIsEveryPlace) {
  const TravelBox none = intersection({{0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}}, {{2.0, 0.0, 0.0}, {3.0, 1.0, 1.0}});
  for (const double x : {0.5, 1.5, 2.5}) EXPECT_TRUE(over_travel(none, {x, 0.5, 0.5}));
}

}  // namespace
}  // namespace haptic::safety
