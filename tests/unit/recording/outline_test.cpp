#include "proto/foxglove/outline.h"

#include <gtest/gtest.h>

#include <cmath>

namespace haptic::view {
namespace {

using Outline = std::vector<std::array<double, 2>>;

double area_of(const std::array<double, 2>& a, const std::array<double, 2>& b,
               const std::array<double, 2>& c) {
  return 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
}

// of all triangles; each must be counter-clockwise or flat
double covered(const Outline& outline) {
  double sum = 0.0;
  for (const auto& [a, b, c] : triangulate(outline)) {
    const double area = area_of(outline.at(a), outline.at(b), outline.at(c));
    EXPECT_GE(area, 0.0);
    sum += area;
  }
  return sum;
}

TEST(Triangulate, FillsAPolygonThatIsNotConvexInEitherSense) {
  const Outline corner = {{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}};  // an L: 3 + 2
  EXPECT_EQ(triangulate(corner).size(), 4U);
  EXPECT_DOUBLE_EQ(covered(corner), 5.0);
  EXPECT_DOUBLE_EQ(covered(Outline(corner.rbegin(), corner.rend())), 5.0);
}

TEST(Triangulate, FillsAPolygonWithPointsOnAStraightEdge) {
  const Outline square = {{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}};
  EXPECT_EQ(triangulate(square).size(), 6U);
  EXPECT_DOUBLE_EQ(covered(square), 4.0);
}

TEST(Triangulate, EndsForWhatIsNoPolygon) {
  EXPECT_TRUE(triangulate({{0, 0}, {1, 1}}).empty());
  EXPECT_EQ(triangulate({{0, 0}, {0, 0}, {0, 0}, {0, 0}}).size(), 2U);
  EXPECT_EQ(triangulate({{0, 0}, {1, 1}, {1, 0}, {0, 1}, {NAN, 2}}).size(), 3U);
}

}  // namespace
}  // namespace haptic::view
