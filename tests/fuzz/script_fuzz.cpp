// Scripts of arbitrary text. Whatever it is: it is refused with a line that it has, or unrolled within the
// limits, and the conditions in it are read or refused.

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <stdexcept>
#include <string_view>

#include "client/cli/condition.h"
#include "client/cli/script_parser.h"

namespace {

void read_condition(const haptic::cli::ScriptLine& line) {
  try {
    haptic::cli::parse_condition(std::span(line.words).subspan(1));
  } catch (const std::invalid_argument&) {
  }
  try {
    if (haptic::cli::parse_duration(line.words.back()) < 0.0) {
      std::abort();
    }
  } catch (const std::invalid_argument&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace haptic::cli;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto lines = static_cast<int>(std::count(text.begin(), text.end(), '\n')) + 1;
  try {
    std::size_t bytes = 0;
    for (const ScriptLine& line : read_script(text, {{"given", "a b"}})) {
      if (line.words.empty() || line.line < 1 || line.line > lines) {
        std::abort();
      }
      for (const std::string& word : line.words) {
        bytes += word.size();
      }
      read_condition(line);
    }
    if (bytes > kMaxUnrolledBytes) {
      std::abort();
    }
  } catch (const ScriptError& error) {
    if (error.line() < 1 || error.line() > lines) {
      std::abort();
    }
  }
  return 0;
}
