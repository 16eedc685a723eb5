#pragma once
// The parser itself: made, given words to read, and asked what it knows.

#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "client/cli/options.h"

namespace haptic::cli {

struct FreeParser {
  void operator()(CLI::App* app) const noexcept;
};
using Parser = std::unique_ptr<CLI::App, FreeParser>;

/// `version`: what --version prints. Words without a verb are refused.
Parser make_parser(const std::string& name, const std::string& help, const std::string& version);

/// Adds a verb below `parent`; when it is chosen, and its arguments are right, `choose` is called.
CLI::App& add_verb(CLI::App& parent, const std::string& name, const std::string& help,
                   std::function<void()> choose);

/// Adds a verb that does nothing itself, but has others below it.
CLI::App& add_family(CLI::App& parent, const std::string& name, const std::string& help);
/// The same, but it may stand alone; `alone` is called then.
CLI::App& add_family(CLI::App& parent, const std::string& name, const std::string& help,
                     std::function<void()> alone);

/// What is wrong with words, for a person: of a verb that is not there its name, and those that it may have
/// been meant to be.
struct UsageError : std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

/// Reads the words behind the program's name, once. Returns a text if that is all they ask for: --help,
/// --version. Throws UsageError.
std::optional<std::string> parse(CLI::App& app, const std::vector<std::string>& words);

/// The verb of the words that have been read, with those above it: "object add".
std::string chosen_verb(const CLI::App& app);

struct CompletedOption {
  std::vector<std::string> names;  // with their dashes
  std::string help;
  std::string value;  // what follows it: a kind, see has_names(); empty: nothing
};

struct CompletedVerb {
  std::string path;  // "object add"; empty: hapticctl itself
  std::string help;
  std::vector<std::string> verbs;  // the paths of those below
  std::vector<CompletedOption> options;
  std::string value;       // the kind of its first argument without a dash
  std::string next_value;  // of its second, if the first is one of some words
};

/// All verbs that help shows, each before those below it.
std::vector<CompletedVerb> completed_verbs(const CLI::App& app);

}  // namespace haptic::cli
