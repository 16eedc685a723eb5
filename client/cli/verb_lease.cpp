#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <memory>
#include <optional>

#include "client/cli/describe.h"
#include "client/cli/screen.h"
#include "client/cli/verbs.h"

namespace haptic::cli {
namespace {

using std::chrono::milliseconds;

// what a shell says of a program that it cannot run
constexpr auto kCannotRun = static_cast<ExitCode>(126);
constexpr auto kNoProgram = static_cast<ExitCode>(127);
constexpr int kSignalled = 128;

constexpr milliseconds kLookAfterChild{20};  // how often the program that runs is looked after

struct LeaseOptions {
  std::uint32_t heartbeat_ms = 0;
  double seconds = 0.0;
  bool arm = false;
  std::vector<std::string> program;
};

class Child {
 public:
  /// The program with its arguments, as the shell finds it. `failure`: errno if it cannot be run.
  Child(const std::vector<std::string>& program, int& failure) {
    std::vector<std::string> words = program;
    std::vector<char*> arguments;
    arguments.reserve(words.size() + 1);
    for (std::string& word : words) {
      arguments.push_back(word.data());
    }
    arguments.push_back(nullptr);
    failure = ::posix_spawnp(&process_, arguments[0], nullptr, nullptr, arguments.data(), environ);
  }

  void tell(int signal) const { ::kill(process_, signal); }

  /// As a shell would tell it; nothing while it runs. With `wait` it is waited for.
  std::optional<ExitCode> exit_code(bool wait = false) const {
    int status = 0;
    pid_t ended = -1;
    do {
      ended = ::waitpid(process_, &status, wait ? 0 : WNOHANG);
    } while (wait && ended < 0 && errno == EINTR);
    if (ended != process_) {
      return std::nullopt;
    }
    return static_cast<ExitCode>(WIFEXITED(status) ? WEXITSTATUS(status) : kSignalled + WTERMSIG(status));
  }

 private:
  pid_t process_ = -1;
};

// events are taken, so that they do not heap up; a lease that is lost is thrown
ExitCode wait(client::Connection& daemon, double seconds) {
  const auto end = client::Clock::now() + std::chrono::duration_cast<client::Clock::duration>(
                                              std::chrono::duration<double>(seconds));
  while (!stop_requested() && (seconds == 0.0 || client::Clock::now() < end)) {
    daemon.receive(kLookAfterChild);
  }
  return kDone;
}

ExitCode run_program(client::Connection& daemon, const std::vector<std::string>& program) {
  int failure = 0;
  const Child child(program, failure);
  if (failure != 0) {
    fmt::print(stderr, "hapticctl: cannot run {}: {}\n", program.front(), std::strerror(failure));
    return failure == ENOENT ? kNoProgram : kCannotRun;
  }
  bool is_told = false;
  try {
    while (true) {
      if (const auto code = child.exit_code()) {
        return *code;
      }
      // Ctrl-C reaches it without us
      if (stop_signal() == SIGTERM && !is_told) {
        child.tell(SIGTERM);
        is_told = true;
      }
      daemon.receive(kLookAfterChild);
    }
  } catch (const client::Error&) {
    child.tell(SIGTERM);
    child.exit_code(true);
    throw;
  }
}

void arm(client::Connection& daemon) {
  try {
    call(daemon, [](v1::Request& request) { request.mutable_arm(); });
  } catch (const client::NothingToDo&) {
    return;  // it was armed before; now the lease is ours
  }
}

void disarm(client::Connection& daemon) {
  try {
    call(daemon, [](v1::Request& request) { request.mutable_disarm(); });
  } catch (const client::NothingToDo&) {
    return;
  }
}

void tell_holder(const Command& command, client::Connection& daemon) {
  const v1::Response response = call(daemon, [](v1::Request& request) { request.mutable_get_status(); });
  if (command.json) {
    print_json(response.status().drive_holder());
  } else {
    fmt::print("{}\n", describe(response.status().drive_holder()));
    std::fflush(stdout);
  }
}

ExitCode hold(Command& command, const LeaseOptions& options) {
  catch_stop_signals();
  client::Connection& daemon = command.connect();
  daemon.acquire_drive(milliseconds(options.heartbeat_ms));
  ExitCode code = kDone;
  try {
    tell_holder(command, daemon);
    if (options.arm) {
      arm(daemon);
    }
    code = options.program.empty() ? wait(daemon, options.seconds) : run_program(daemon, options.program);
    if (options.arm) {
      disarm(daemon);
    }
  } catch (const client::Refused&) {
    daemon.release_drive();
    throw;
  } catch (const client::FaultLatched&) {
    daemon.release_drive();
    throw;
  }
  daemon.release_drive();
  return code;
}

}  // namespace

void add_lease(CLI::App& app, Command& command) {
  const auto options = std::make_shared<LeaseOptions>();
  CLI::App& verb = add_verb(app, command, "lease", "hold the drive lease: nobody else can arm meanwhile",
                            [options](Command& chosen) { return hold(chosen, *options); });
  const Option seconds =
      add_option(verb, "--seconds", options->seconds, "release it after so long; default: on Ctrl-C")
          .positive();
  add_option(verb, "--heartbeat", options->heartbeat_ms,
             "the longest silence until it is lost; default: that of the daemon's config")
      .between(1U, 3'600'000U, Told::kInHelp)
      .type("MS");
  add_flag(verb, "--arm", options->arm, "allow force while it is held, and forbid it before it is released");
  add_option(verb, "command", options->program,
             "after --: hold it while this runs, and exit with its exit code")
      .type("COMMAND")
      .excludes(seconds);
  set_footer(
      verb,
      "If hapticctl dies or falls silent, forces go down and a fault is latched, or what drive.on_loss of "
      "the\n"
      "daemon's config says. If the lease is lost COMMAND gets SIGTERM.\n"
      "hapticctl lease --arm -- ./experiment --subject 7");
}

}  // namespace haptic::cli
