#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "client/cli/describe.h"
#include "client/cli/verbs.h"

namespace haptic::cli {
namespace {

ExitCode report(const Command& command, const v1::Response& response, const std::string& what) {
  if (command.json) {
    print_json(response.done());
  } else {
    fmt::print("{}\n", what);
  }
  return kDone;
}

ExitCode pause(Command& command) {
  client::Connection& daemon = command.connect();
  return report(command, call(daemon, [](v1::Request& request) { request.mutable_pause(); }), "paused");
}

ExitCode resume(Command& command) {
  client::Connection& daemon = command.connect();
  return report(command, call(daemon, [](v1::Request& request) { request.mutable_resume(); }), "running");
}

ExitCode step(Command& command, std::uint64_t ticks) {
  // the daemon answers when they have run, at 100 Hz in the slowest case
  client::Connection& daemon =
      command.connect(std::chrono::seconds(10 + std::min<std::uint64_t>(ticks / 100, 3600)));
  return report(command,
                call(daemon, [ticks](v1::Request& request) { request.mutable_step()->set_ticks(ticks); }),
                "ran " + count_of(ticks, "tick") + "; paused");
}

}  // namespace

void add_pause(CLI::App& app, Command& command) {
  add_verb(app, command, "pause", "hold the scene still", pause);
  add_verb(app, command, "resume", "let it go on", resume);
  const auto ticks = std::make_shared<std::uint64_t>(1);
  CLI::App& verb = add_verb(app, command, "step", "run some ticks while paused",
                            [ticks](Command& chosen) { return step(chosen, *ticks); });
  add_option(verb, "ticks", *ticks, "how many").positive().show_default();
}

}  // namespace haptic::cli
