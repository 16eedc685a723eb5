#pragma once
// A static tree of axis-aligned boxes: asked by the Out state for the hull triangles near a path, and by
// `locate` for the cells near a point. Built once; queries allocate nothing and are real-time safe.

#include <algorithm>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <span>
#include <vector>

namespace haptic::engine {

/// Axis-aligned box (m); empty until something is added.
struct Box {
  glm::dvec3 low{std::numeric_limits<double>::infinity()};
  glm::dvec3 high{-std::numeric_limits<double>::infinity()};

  void add(const glm::dvec3& p) noexcept {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  void add(const Box& box) noexcept {
    low = glm::min(low, box.low);
    high = glm::max(high, box.high);
  }
  bool overlaps(const Box& other) const noexcept {
    return low.x <= other.high.x && other.low.x <= high.x && low.y <= other.high.y && other.low.y <= high.y &&
           low.z <= other.high.z && other.low.z <= high.z;
  }
};

class BoxTree {
 public:
  BoxTree() = default;

  /// Over items 0 .. boxes.size() - 1. Not real-time safe.
  explicit BoxTree(std::span<const Box> boxes);

  /// Calls visit(item) for each item whose box overlaps `query`, and for some whose box does not: leaves hold
  /// a few items and are visited whole. The order depends on the tree only. Real-time safe if `visit` is.
  template <class Visit>
  void visit_overlaps(const Box& query, Visit&& visit) const noexcept;

  std::size_t bytes() const noexcept {
    return nodes_.size() * sizeof(Node) + items_.size() * sizeof(std::uint32_t);
  }

 private:
  static constexpr std::uint32_t kLeafItems = 4;
  static constexpr int kMaxDepth = 64;  // halving 2^32 items needs 32

  struct Node {
    Box box;
    std::uint32_t first = 0;  // leaf: first of items_; inner: left child (the right one follows it)
    std::uint32_t count = 0;  // leaf: number of items; inner: 0
  };

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> items_;
};

template <class Visit>
void BoxTree::visit_overlaps(const Box& query, Visit&& visit) const noexcept {
  if (nodes_.empty()) return;
  std::uint32_t stack[kMaxDepth];
  int depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const Node& node = nodes_[stack[--depth]];
    if (!node.box.overlaps(query)) continue;
    if (node.count == 0) {
      stack[depth++] = node.first + 1;
      stack[depth++] = node.first;
    } else {
      for (std::uint32_t i = 0; i < node.count; ++i) visit(items_[node.first + i]);
    }
  }
}

}  // namespace haptic::engine
