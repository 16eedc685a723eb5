#pragma once
// The text of a script as the lines that run, one after the other. Pure: no daemon, no file, no clock.
//
//     # words as a shell has them: 'literal', "with $variables", \ takes the next character or line as it is
//     set lift 0.02                       # a name given with --define keeps that value
//     for name in box1 box2               # loops may be nested
//       object move $name --at 0 $lift 0
//     end
//
// Values of variables and lists of loops are known before anything runs, so all of it is unrolled here. An
// unquoted $name falls apart at its spaces, a "$name" does not. Every length and count has a limit.

#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace haptic::cli {

/// What is wrong, and where; lines count from 1.
class ScriptError : public std::runtime_error {
 public:
  ScriptError(int line, const std::string& message) : std::runtime_error(message), line_(line) {}
  int line() const noexcept { return line_; }

 private:
  int line_;
};

struct ScriptLine {
  int line = 0;                    // where it begins in the text
  std::vector<std::string> words;  // at least one
};

using Variables = std::map<std::string, std::string>;

/// Bounds of what a script may ask for, far above what one needs.
constexpr std::size_t kMaxScriptBytes = std::size_t{1} << 20;
constexpr std::size_t kMaxLineBytes = std::size_t{1} << 16;  // after variables have been replaced
constexpr std::size_t kMaxUnrolledBytes = std::size_t{1} << 22;
constexpr int kMaxStatements = 50'000;  // that unrolling passes through
constexpr int kMaxNesting = 16;

/// Throws ScriptError.
std::vector<ScriptLine> read_script(std::string_view text, const Variables& defines);

/// Letters, digits and _, not a digit first.
bool is_variable_name(std::string_view text) noexcept;

}  // namespace haptic::cli
