// hapticctl: talks to hapticd. Results go to standard output, errors to standard error, and what became of it
// to the exit code (exit_code.h).

#include <cstdio>
#include <exception>

#include "client/cli/usage.h"
#include "client/cli/verbs.h"

namespace haptic::cli {
namespace {

int run(int argc, char** argv) {
  Command command;
  const std::unique_ptr<CLI::App> app = make_app(command);
  try {
    app->parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {
      return app->exit(error);  // --help, --version
    }
    std::fprintf(stderr, "hapticctl: %s; see hapticctl --help\n", in_words(error, *app).c_str());
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
