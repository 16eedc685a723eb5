#include "proto/foxglove/outline.h"

#include <algorithm>
#include <numeric>

namespace haptic::view {
namespace {

using Point = std::array<double, 2>;

// twice the area, positive if c is left of a -> b
double area(const Point& a, const Point& b, const Point& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

double area(const std::vector<Point>& outline) {
  double sum = 0.0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    sum += area({0.0, 0.0}, outline[i], outline[(i + 1) % outline.size()]);
  }
  return sum;
}

// the corner at place i of what is left can be cut off: it is convex, and no other point is within
bool is_ear(const std::vector<Point>& outline, const std::vector<std::uint32_t>& left, std::size_t i) {
  const std::size_t n = left.size();
  const std::uint32_t before = left[(i + n - 1) % n];
  const std::uint32_t here = left[i];
  const std::uint32_t after = left[(i + 1) % n];
  if (area(outline[before], outline[here], outline[after]) <= 0.0) {
    return false;
  }
  for (const std::uint32_t other : left) {
    if (other != before && other != here && other != after &&
        area(outline[before], outline[here], outline[other]) >= 0.0 &&
        area(outline[here], outline[after], outline[other]) >= 0.0 &&
        area(outline[after], outline[before], outline[other]) >= 0.0) {
      return false;
    }
  }
  return true;
}

}  // namespace

std::vector<std::array<std::uint32_t, 3>> triangulate(const std::vector<std::array<double, 2>>& outline) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  if (outline.size() < 3) {
    return triangles;
  }
  std::vector<std::uint32_t> left(outline.size());
  std::iota(left.begin(), left.end(), 0U);
  if (area(outline) < 0.0) {
    std::reverse(left.begin(), left.end());
  }
  triangles.reserve(outline.size() - 2);
  std::size_t i = 0;
  std::size_t tried =
      0;  // without an ear; after a round any corner is taken, which ends on straight edges, too
  while (left.size() > 3) {
    i %= left.size();
    if (is_ear(outline, left, i) || tried > left.size()) {
      const std::size_t n = left.size();
      triangles.push_back({left[(i + n - 1) % n], left[i], left[(i + 1) % n]});
      left.erase(left.begin() + static_cast<std::ptrdiff_t>(i));
      tried = 0;
    } else {
      ++i;
      ++tried;
    }
  }
  triangles.push_back({left[0], left[1], left[2]});
  return triangles;
}

}  // namespace haptic::view
