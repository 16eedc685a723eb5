// hapticctl: talks to hapticd. Results go to standard output, errors to standard error, and what became of it
// to the exit code (exit_code.h).

#include <cstdio>
#include <exception>

#include "client/cli/verbs.h"

int main(int argc, char** argv) {
  using namespace haptic;
  cli::Command command;
  CLI::App app("Talks to hapticd, the haptics daemon", "hapticctl");
  app.set_version_flag("--version", "hapticctl " HAPTIC_VERSION);
  app.require_subcommand(1);
  cli::add_common_options(app, command);
  cli::add_verbs(app, command);
  app.footer(
      "The daemon is looked for at --socket, else --server, else HAPTICD_SERVER, else HAPTICD_SOCKET, else\n"
      "the system service's socket, else the user's own. HAPTICD_CERTIFICATE, HAPTICD_KEY and\n"
      "HAPTICD_AUTHORITY stand for the options of TLS.\n"
      "Exit codes: 0 done, 1 failed, 2 nothing to do, 3 not found, 4 refused, 5 daemon unreachable,\n"
      "6 protocol mismatch, 7 fault latched, 64 usage.");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {
      return app.exit(error);  // --help, --version
    }
    std::fprintf(stderr, "hapticctl: %s; see hapticctl --help\n", error.what());
    return cli::kUsage;
  }
  try {
    return command.action(command);
  } catch (const client::Error& error) {
    std::fprintf(stderr, "hapticctl: %s\n", error.what());
    return cli::exit_code(error);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "hapticctl: %s\n", error.what());
    return cli::kFailed;
  }
}
