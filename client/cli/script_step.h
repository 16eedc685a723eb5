#pragma once
// A line of a script as what it does. Pure, but for the verbs, whose arguments hapticctl's own parser reads.

#include <string>
#include <variant>

#include "client/cli/command.h"
#include "client/cli/condition.h"
#include "client/cli/script_parser.h"

namespace haptic::cli {

struct WaitStep {
  double seconds = 0.0;
};
struct WaitUntilStep {
  Condition condition;
  double seconds = 0.0;  // failed if it does not hold within
};
struct ExpectStep {
  Condition condition;
};
struct EchoStep {
  std::string text;
};
struct VerbStep {
  std::string verb;  // "arm", "object move"
  std::vector<std::string> words;
};

// record alone can be started: it goes on beside the lines that follow, until it is stopped or the script
// ends
struct StartStep {
  std::vector<std::string> words;  // of the verb
};
struct StopStep {};

using Step = std::variant<WaitStep, WaitUntilStep, ExpectStep, EchoStep, VerbStep, StartStep, StopStep>;

/// Throws ScriptError if the line is not right; nothing runs.
Step make_step(const ScriptLine& line);

/// Reads the words as hapticctl does, after which `command.action` does what they say. Returns the verb
/// without its options: "arm", "object move". Throws std::invalid_argument in words if they are wrong, or are
/// no verb for a script.
std::string parse_verb(const std::vector<std::string>& words, Command& command);

}  // namespace haptic::cli
