#pragma once
// A .node and a .ele file in one text, with a line "---" between them: how the fuzz corpus keeps such pairs.

#include <string_view>
#include <utility>

namespace haptic::test {

inline std::pair<std::string_view, std::string_view> split_tetgen_pair(std::string_view both) {
  constexpr std::string_view kSeparator = "---\n";
  const std::size_t at = both.find(kSeparator);
  if (at == std::string_view::npos) return {both, {}};
  return {both.substr(0, at), both.substr(at + kSeparator.size())};
}

}  // namespace haptic::test
