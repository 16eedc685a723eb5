// hapticctl: talks to hapticd. Results go to standard output, errors to standard error, and what became of it
// to the exit code (exit_code.h).

#include <cstdio>
#include <exception>

#include "client/cli/verbs.h"

int main(int argc, char** argv) {
  using namespace haptic;
  cli::Command command;
  const std::unique_ptr<CLI::App> app = cli::make_app(command);
  try {
    app->parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {
      return app->exit(error);  // --help, --version
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
