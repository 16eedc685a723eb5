// haptic-view: shows what hapticd does to browsers and viewers, until SIGTERM or SIGINT. Standard error tells
// where it listens. Exit codes: 0 done, 1 failed, 64 usage.

#include <signal.h>

#include <cstdio>
#include <exception>
#include <filesystem>

#include "client/view/command_line.h"

namespace haptic::gateway {
namespace {

constexpr int kFailed = 1;
constexpr int kUsage = 64;

void log(const std::string& line) { std::fprintf(stderr, "haptic-view: %s\n", line.c_str()); }

void tell_start(const Gateway& gateway, const Options& options) {
  log("serves " + gateway.url());
  std::error_code error;
  if (!std::filesystem::is_regular_file(options.web.page / "index.html", error)) {
    log("there is no page in " + options.web.page.string() + "; WebSockets are served all the same");
  }
  if (options.web.rules.anybody_drives) {
    log("everybody who can use this machine may drive the devices");
  }
}

int run(int argc, char** argv) {
  Choice choice;
  const std::unique_ptr<CLI::App> app = make_app(choice);
  Options options;
  try {
    app->parse(argc, argv);
    options = options_of(std::move(choice));
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {
      return app->exit(error);  // --help, --version
    }
    const bool is_of_config = dynamic_cast<const CLI::ConfigError*>(&error) != nullptr;
    log((is_of_config ? "the file of --config: " : "") + std::string(error.what()) +
        "; see haptic-view --help");
    return kUsage;
  }
  ::signal(SIGPIPE, SIG_IGN);
  Gateway gateway(options, log);
  gateway.stop_on_signals();
  tell_start(gateway, options);
  gateway.run();
  return 0;
}

}  // namespace
}  // namespace haptic::gateway

int main(int argc, char** argv) {
  try {
    return haptic::gateway::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "haptic-view: %s\n", error.what());
    return haptic::gateway::kFailed;
  }
}
