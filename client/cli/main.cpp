// hapticctl: talks to hapticd. Results go to standard output, errors to standard error, and what became of it
// to the exit code (exit_code.h).

#include <algorithm>
#include <cstdio>
#include <exception>

#include "client/cli/verbs.h"

namespace haptic::cli {
namespace {

int run(int argc, char** argv) {
  Command command;
  const Parser app = make_app(command);
  try {
    if (const auto text = parse(*app, {argv + std::min(argc, 1), argv + argc})) {
      std::fwrite(text->data(), 1, text->size(), stdout);
      return kDone;
    }
  } catch (const UsageError& error) {
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
