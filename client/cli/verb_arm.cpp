#include <fmt/format.h>

#include "client/cli/verbs.h"

namespace haptic::cli {
namespace {

ExitCode report(const Command& command, const v1::Response& response, const char* what) {
  if (command.json) {
    print_json(response.done());
  } else {
    fmt::print("{}\n", what);
  }
  return kDone;
}

ExitCode arm(Command& command) {
  client::Connection& daemon = command.connect();
  return report(command, call(daemon, [](v1::Request& request) { request.mutable_arm(); }),
                "armed: devices may push now");
}

ExitCode disarm(Command& command) {
  client::Connection& daemon = command.connect();
  return report(command, call(daemon, [](v1::Request& request) { request.mutable_disarm(); }),
                "disarmed: no device pushes");
}

ExitCode stop_emergency(Command& command) {
  client::Connection& daemon = command.connect();
  return report(command, call(daemon, [](v1::Request& request) { request.mutable_emergency_stop(); }),
                "stopped: no device pushes, until somebody clears the fault");
}

}  // namespace

void add_arm(CLI::App& app, Command& command) {
  add_verb(app, command, "arm", "allow force", arm);
  add_verb(app, command, "disarm", "forbid force", disarm);
  add_verb(app, command, "estop", "emergency stop: end all force at once, and latch a fault", stop_emergency);
}

}  // namespace haptic::cli
