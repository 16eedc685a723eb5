#pragma once
// What is wrong with a command line, for a person.

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace haptic::cli {

/// The parser's own words; of a verb that is not there its name, and those that it may have been meant to be.
/// `app` has just failed to parse with `error`.
std::string in_words(const CLI::ParseError& error, const CLI::App& app);

/// Those of `names` that begin with `word`, or are a slip or two of the keyboard away from it: the nearest
/// first, at most three.
std::vector<std::string> near_to(const std::string& word, const std::vector<std::string>& names);

}  // namespace haptic::cli
