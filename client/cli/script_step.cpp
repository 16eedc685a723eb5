#include "client/cli/script_step.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "client/cli/verbs.h"

namespace haptic::cli {
namespace {

using Words = std::span<const std::string>;

Step make_wait(Words words) {
  if (words.size() == 1 && words[0] != "until") {
    return WaitStep{parse_duration(words[0])};
  }
  // until CONDITION for DURATION
  if (words.size() < 4 || words[0] != "until" || words[words.size() - 2] != "for") {
    throw std::invalid_argument("wait is written: wait 2s, or wait until CONDITION for 2s");
  }
  return WaitUntilStep{parse_condition(words.subspan(1, words.size() - 3)), parse_duration(words.back())};
}

Step make_start(const std::vector<std::string>& words) {
  const std::vector<std::string> verb(words.begin() + 1, words.end());
  if (verb.empty() || verb[0] != "record") {
    throw std::invalid_argument("start is written: start record FILE");
  }
  Command unused;
  parse_verb(verb, unused);
  return StartStep{verb};
}

Step make_any(const std::vector<std::string>& words) {
  const Words rest = Words(words).subspan(1);
  if (words[0] == "wait") {
    return make_wait(rest);
  }
  if (words[0] == "expect") {
    return ExpectStep{parse_condition(rest)};
  }
  if (words[0] == "echo") {
    return EchoStep{fmt::format("{}", fmt::join(rest, " "))};
  }
  if (words[0] == "start") {
    return make_start(words);
  }
  if (words[0] == "stop") {
    if (rest.size() != 1 || rest[0] != "record") {
      throw std::invalid_argument("stop is written: stop record");
    }
    return StopStep{};
  }
  Command unused;
  return VerbStep{parse_verb(words, unused), words};
}

}  // namespace

Step make_step(const ScriptLine& line) {
  try {
    return make_any(line.words);
  } catch (const std::invalid_argument& error) {
    throw ScriptError(line.line, error.what());
  }
}

std::string parse_verb(const std::vector<std::string>& words, Command& command) {
  for (const char* other : {"run", "lease", "completion", "__names"}) {
    if (words[0] == other) {
      throw std::invalid_argument(words[0] + " is not for scripts");
    }
  }
  const std::string address = command.address;
  const std::string server = command.server;
  const Parser app = make_app(command);
  if (parse(*app, words)) {
    throw std::invalid_argument("help is not for scripts");
  }
  if (command.address != address || command.server != server) {
    throw std::invalid_argument("a script talks to one daemon: --socket and --server belong before its name");
  }
  return chosen_verb(*app);
}

}  // namespace haptic::cli
