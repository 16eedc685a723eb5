#include "engine/box_tree.h"

#include <numeric>

namespace haptic::engine {

BoxTree::BoxTree(std::span<const Box> boxes) : items_(boxes.size()) {
  if (boxes.empty()) return;
  std::iota(items_.begin(), items_.end(), 0U);
  nodes_.reserve(2 * boxes.size() / kLeafItems + 1);

  struct Task {
    std::uint32_t node, first, count;
  };
  std::vector<Task> tasks{{0, 0, static_cast<std::uint32_t>(boxes.size())}};
  nodes_.emplace_back();
  while (!tasks.empty()) {
    const Task task = tasks.back();
    tasks.pop_back();
    Box box;
    Box centres;
    for (std::uint32_t i = task.first; i < task.first + task.count; ++i) {
      box.add(boxes[items_[i]]);
      centres.add(0.5 * (boxes[items_[i]].low + boxes[items_[i]].high));
    }
    nodes_[task.node].box = box;
    if (task.count <= kLeafItems) {
      nodes_[task.node].first = task.first;
      nodes_[task.node].count = task.count;
      continue;
    }
    // halve at the median along the axis on which the centres are spread most; ties by item keep the order
    // unique
    const glm::dvec3 spread = centres.high - centres.low;
    const int axis = spread.x >= spread.y && spread.x >= spread.z ? 0 : (spread.y >= spread.z ? 1 : 2);
    const auto centre = [&](std::uint32_t item) { return boxes[item].low[axis] + boxes[item].high[axis]; };
    const std::uint32_t half = task.count / 2;
    const auto begin = items_.begin() + task.first;
    std::nth_element(begin, begin + half, begin + task.count, [&](std::uint32_t a, std::uint32_t b) {
      return centre(a) != centre(b) ? centre(a) < centre(b) : a < b;
    });
    const auto left = static_cast<std::uint32_t>(nodes_.size());
    nodes_.emplace_back();
    nodes_.emplace_back();
    nodes_[task.node].first = left;
    tasks.push_back({left, task.first, half});
    tasks.push_back({left + 1, task.first + half, task.count - half});
  }
}

}  // namespace haptic::engine
