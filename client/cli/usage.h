#pragma once
// What was meant by a word that is none.

#include <string>
#include <vector>

namespace haptic::cli {

/// Those of `names` that begin with `word`, or are a slip or two of the keyboard away from it: the nearest
/// first, at most three.
std::vector<std::string> near_to(const std::string& word, const std::vector<std::string>& names);

}  // namespace haptic::cli
