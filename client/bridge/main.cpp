// haptic-bridge: passes on what hapticd tells to a NATS server, until SIGTERM or SIGINT. Standard error tells
// when either is found or lost. Exit codes: 0 done, 1 failed, 64 usage.

#include <pthread.h>
#include <signal.h>

#include <cstdio>
#include <exception>

#include "client/bridge/command_line.h"

namespace haptic::bridge {
namespace {

constexpr int kFailed = 1;
constexpr int kUsage = 64;

void log(const std::string& line) { std::fprintf(stderr, "haptic-bridge: %s\n", line.c_str()); }

// blocked in every thread that follows, so that this one waits for them
sigset_t block_stop_signals() {
  sigset_t signals;
  ::sigemptyset(&signals);
  ::sigaddset(&signals, SIGTERM);
  ::sigaddset(&signals, SIGINT);
  ::pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  ::signal(SIGPIPE, SIG_IGN);
  return signals;
}

int run(int argc, char** argv) {
  Choice choice;
  const std::unique_ptr<CLI::App> app = make_app(choice);
  try {
    app->parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {
      return app->exit(error);  // --help, --version
    }
    const bool is_of_config = dynamic_cast<const CLI::ConfigError*>(&error) != nullptr;
    log((is_of_config ? "the file of --config: " : "") + std::string(error.what()) +
        "; see haptic-bridge --help");
    return kUsage;
  }
  const sigset_t signals = block_stop_signals();
  {
    Bridge bridge(options_of(std::move(choice)), log);
    int signal = 0;
    ::sigwait(&signals, &signal);
    bridge.stop();
  }
  close_broker_library();
  return 0;
}

}  // namespace
}  // namespace haptic::bridge

int main(int argc, char** argv) {
  try {
    return haptic::bridge::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "haptic-bridge: %s\n", error.what());
    return haptic::bridge::kFailed;
  }
}
