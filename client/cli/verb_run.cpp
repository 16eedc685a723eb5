#include <fmt/format.h>

#include <fstream>
#include <iostream>
#include <iterator>
#include <memory>

#include "client/cli/script_runner.h"
#include "client/cli/verbs.h"

namespace haptic::cli {
namespace {

struct RunOptions {
  std::string script;
  std::vector<std::string> defines;  // name=value
};

// one byte more than a script may have tells that it is too long
std::string read_all(std::istream& stream) {
  std::string text;
  char chunk[4096];
  while (text.size() <= kMaxScriptBytes && (stream.read(chunk, sizeof(chunk)) || stream.gcount() > 0)) {
    text.append(chunk, static_cast<std::size_t>(stream.gcount()));
  }
  return text;
}

ExitCode run(const Command& command, const RunOptions& options) {
  Variables defines;
  for (const std::string& define : options.defines) {
    const std::size_t equals = define.find('=');
    defines[define.substr(0, equals)] = define.substr(equals + 1);
  }
  if (options.script == "-") {
    return ScriptRunner(command, "standard input").run(read_all(std::cin), defines);
  }
  std::ifstream file(options.script, std::ios::binary);
  const std::string text = read_all(file);
  if (!file.is_open() || file.bad()) {
    fmt::print(stderr, "hapticctl: cannot read {}\n", options.script);
    return kNotFound;
  }
  return ScriptRunner(command, options.script).run(text, defines);
}

std::string check_define(const std::string& text) {
  const std::size_t equals = text.find('=');
  const bool good = equals != std::string::npos && is_variable_name(text.substr(0, equals));
  return good ? "" : "'" + text + "' is not name=value";
}

}  // namespace

void add_run(CLI::App& app, Command& command) {
  const auto options = std::make_shared<RunOptions>();
  CLI::App& verb = add_verb(app, command, "run", "run a script: one verb a line",
                            [options](Command& chosen) { return run(chosen, *options); });
  add_option(verb, "script", options->script, "a file, or - for standard input").required().type("FILE");
  add_option(verb, "--define", options->defines,
             "a variable of the script, which its own set does not change")
      .type("NAME=VALUE")
      .repeatable()
      .check(check_define);
  set_footer(
      verb,
      "Beside every verb of hapticctl a script has: # comments, set name value, $name, for name in a b ...\n"
      "end, echo, wait 2s, wait until CONDITION for 5s, expect CONDITION, start record FILE, stop record. A "
      "CONDITION is: object NAME.x (y, "
      "z,\n"
      "vx, vy, vz, speed), finger NAME.force (touching, slipping), device NAME.force (x, y, z, armed) or "
      "tick,\n"
      "then <, <=, >, >= or == and a number; == of a measured quantity also: within TOLERANCE. All of it is\n"
      "checked before anything runs. The first line that fails ends it with that line's exit code; having\n"
      "nothing to do is no failure.");
}

}  // namespace haptic::cli
