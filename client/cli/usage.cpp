#include "client/cli/usage.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace haptic::cli {
namespace {

constexpr std::size_t kMost = 3;

// how many letters are inserted, left away, replaced or exchanged with their neighbour, at the least
std::size_t distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> before(b.size() + 1);
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::vector<std::size_t> next(b.size() + 1, i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = row[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      next[j] = std::min({replaced, row[j] + 1, next[j - 1] + 1});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        next[j] = std::min(next[j], before[j - 2] + 1);
      }
    }
    before = std::exchange(row, std::move(next));
  }
  return row.back();
}

}  // namespace

std::vector<std::string> near_to(const std::string& word, const std::vector<std::string>& names) {
  std::vector<std::pair<std::size_t, std::string>> found;
  for (const std::string& name : names) {
    const bool is_begun = !word.empty() && name.rfind(word, 0) == 0;
    const std::size_t away = is_begun ? 0 : distance(word, name);
    const std::size_t permitted = std::max<std::size_t>(1, std::min(word.size(), name.size()) / 3);
    if (away <= permitted) {
      found.emplace_back(away, name);
    }
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  found.resize(std::min(found.size(), kMost));
  std::vector<std::string> nearest;
  nearest.reserve(found.size());
  for (auto& [away, name] : found) {
    nearest.push_back(std::move(name));
  }
  return nearest;
}

}  // namespace haptic::cli
