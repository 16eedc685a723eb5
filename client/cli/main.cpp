// hapticctl: talks to hapticd. Results go to standard output, errors to standard error, and what became of it
// to the exit code (exit_code.h).

#include <cstdio>
#include <exception>

#include "client/cli/verbs.h"

namespace haptic::cli {
namespace {

int run(int argc, char** argv) {
  Command command;
  CLI::App app("Talks to hapticd, the haptics daemon", "hapticctl");
  app.set_version_flag("--version", "hapticctl " HAPTIC_VERSION);
  app.require_subcommand(1);
  add_common_options(app, command);
  add_verbs(app, command);
  app.footer(
      "The daemon is looked for at --socket, else HAPTICD_SOCKET, else the system service's socket, else "
      "the\n"
      "user's own. Exit codes: 0 done, 1 failed, 2 nothing to do, 3 not found, 4 refused, 5 daemon\n"
      "unreachable, 6 protocol mismatch, 7 fault latched, 64 usage.");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {
      return app.exit(error);  // --help, --version
    }
    std::fprintf(stderr, "hapticctl: %s; see hapticctl --help\n", error.what());
    return kUsage;
  }
  try {
    return command.action(command);
  } catch (const client::Error& error) {
    std::fprintf(stderr, "hapticctl: %s\n", error.what());
    return exit_code(error);
  }
}

}  // namespace
}  // namespace haptic::cli

int main(int argc, char** argv) {
  try {
    return haptic::cli::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "hapticctl: %s\n", error.what());
    return haptic::cli::kFailed;
  }
}
