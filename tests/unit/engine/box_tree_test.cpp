#include "engine/box_tree.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace haptic::engine {
namespace {

using glm::dvec3;

std::vector<Box> random_boxes(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> place(-1.0, 1.0);
  std::uniform_real_distribution<double> size(0.0, 0.1);
  std::vector<Box> boxes(count);
  for (Box& box : boxes) {
    box.low = {place(random), place(random), place(random)};
    box.high = box.low + dvec3{size(random), size(random), size(random)};
  }
  return boxes;
}

std::vector<std::uint32_t> visited(const BoxTree& tree, const Box& query) {
  std::vector<std::uint32_t> items;
  tree.visit_overlaps(query, [&](std::uint32_t item) { items.push_back(item); });
  return items;
}

TEST(BoxTree, VisitsEveryOverlapOnceWhateverTheNumberOfItems) {
  for (const std::size_t count : {1U, 2U, 4U, 5U, 9U, 100U, 5000U}) {
    const std::vector<Box> boxes = random_boxes(count, static_cast<unsigned>(count));
    const BoxTree tree(boxes);
    for (const Box& query : random_boxes(200, 99)) {
      const std::vector<std::uint32_t> items = visited(tree, query);
      const std::set<std::uint32_t> once(items.begin(), items.end());
      EXPECT_EQ(once.size(), items.size());
      for (std::uint32_t i = 0; i < count; ++i) {
        EXPECT_TRUE(once.contains(i) || !boxes[i].overlaps(query)) << i << " of " << count;
      }
    }
  }
}

TEST(BoxTree, VisitsFewItemsThatDoNotOverlap) {
  const std::vector<Box> boxes = random_boxes(5000, 1);
  const BoxTree tree(boxes);
  std::size_t most = 0;
  for (const Box& query : random_boxes(200, 99)) most = std::max(most, visited(tree, query).size());
  // a query of 0.1 meets some 5000 x (0.15 / 2)^3 = 2 boxes, and each drags the up to 3 others of its leaf
  // along
  EXPECT_LT(most, 100U);
}

TEST(BoxTree, EmptyTreeVisitsNothing) {
  EXPECT_TRUE(visited(BoxTree(), {dvec3{-1.0}, dvec3{1.0}}).empty());
  EXPECT_TRUE(visited(BoxTree(std::vector<Box>{}), {dvec3{-1.0}, dvec3{1.0}}).empty());
}

TEST(BoxTree, BoxesThatTouchOverlap) {
  const std::vector<Box> boxes{{dvec3{0.0}, dvec3{1.0}}};
  EXPECT_EQ(visited(BoxTree(boxes), {dvec3{1.0}, dvec3{2.0}}).size(), 1U);
  EXPECT_EQ(visited(BoxTree(boxes), {dvec3{1.0 + 1e-15}, dvec3{2.0}}).size(), 0U);
}

TEST(BoxTree, EqualBoxesAreStillHalved) {
  const std::vector<Box> boxes(10000, {dvec3{0.0}, dvec3{1.0}});
  EXPECT_EQ(visited(BoxTree(boxes), {dvec3{0.5}, dvec3{0.5}}).size(), boxes.size());
}

TEST(BoxTree, QueryWithoutANumberVisitsNothing) {
  const std::vector<Box> boxes = random_boxes(100, 1);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(visited(BoxTree(boxes), {dvec3{nan}, dvec3{nan}}).empty());
}

TEST(BoxTree, OrderOfVisitsIsReproducible) {
  const std::vector<Box> boxes = random_boxes(3000, 4);
  const Box all{dvec3{-2.0}, dvec3{2.0}};
  EXPECT_EQ(visited(BoxTree(boxes), all), visited(BoxTree(boxes), all));
}

}  // namespace
}  // namespace haptic::engine
