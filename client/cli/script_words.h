#pragma once
// A line of a script as words in which variables are not replaced yet.

#include <string>
#include <string_view>
#include <vector>

namespace haptic::cli {

struct Piece {
  std::string text;  // as it is, or the name of a variable
  bool variable = false;
  bool quoted = false;
};

using Word = std::vector<Piece>;

/// Throws ScriptError with the given line.
std::vector<Word> split_words(std::string_view text, int line);

}  // namespace haptic::cli
