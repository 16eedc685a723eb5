#include <fmt/format.h>

#include "client/cli/verbs.h"

namespace haptic::cli {
namespace {

ExitCode clear(Command& command) {
  client::Connection& daemon = command.connect();
  const v1::Response response = call(daemon, [](v1::Request& request) { request.mutable_clear_fault(); });
  if (command.json) {
    print_json(response.done());
  } else {
    fmt::print("faults cleared; still disarmed\n");
  }
  return kDone;
}

}  // namespace

void add_clear(CLI::App& app, Command& command) {
  add_verb(app, command, "clear", "clear latched faults, once their cause is gone", clear);
}

}  // namespace haptic::cli
