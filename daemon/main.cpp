// hapticd: the daemon and its offline verbs. What a verb finds goes to standard output, errors to standard
// error. Exit codes: 0 done, 1 failed, 64 usage.

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <exception>
#include <functional>
#include <iostream>
#include <string>
#include <vector>

#include "daemon/run.h"
#include "ipc/tls.h"
#include "load/check.h"
#include "simulate/replay_file.h"
#include "simulate/simulate.h"

namespace {

constexpr int kDone = 0;
constexpr int kFailed = 1;
constexpr int kUsage = 64;

/// What a verb does, and the exit code; set by its options when it is given.
using Action = std::function<int()>;

void add_run(CLI::App& app, haptic::RunOptions& options, Action& action) {
  CLI::App* const verb = app.add_subcommand("run", "Owns the devices and serves clients until it is stopped");
  verb->add_option("--config", options.config, "the daemon's config")->required();
  verb->add_option("--scene", options.scene, "the scene to start with, instead of the config's");
  verb->add_option("--socket", options.socket, "listen at this path alone, instead of where the config says");
  verb->add_flag("--foreground", options.foreground,
                 "log with times, for a person, instead of for a journal");
  verb->callback([&] {
    action = [&] {
      haptic::run(options);
      return kDone;
    };
  });
}

void add_check(CLI::App& app, haptic::load::CheckOptions& options, Action& action) {
  CLI::App* const verb =
      app.add_subcommand("check", "Tells whether a config and a scene are right, and what they say");
  verb->add_option("--config", options.config, "the daemon's config");
  verb->add_option("--scene", options.scene, "a scene; left away: the one that the config names");
  verb->add_flag("--json", options.json, "one JSON object instead of text");
  options.tls_problems = [](const haptic::v1::Listen::Tls& config) {
    std::vector<haptic::load::TlsProblem> problems;
    for (auto& [field, message] : haptic::ipc::find_problems(config)) {
      problems.push_back({field, message});
    }
    return problems;
  };
  verb->callback([&] { action = [&] { return haptic::load::check(options, std::cout, std::cerr); }; });
}

struct SimulateChoice {
  haptic::simulate::SimulateOptions options;
  haptic::simulate::ReplayOptions replay;  // instead, if it has a file
};

int simulate(const SimulateChoice& choice) {
  if (!choice.replay.file.empty()) {
    return haptic::simulate::replay(choice.replay, std::cout) ? kDone : kFailed;
  }
  haptic::simulate::simulate(choice.options, std::cerr);
  return kDone;
}

/// A config and a duration, or a recording.
void check_choice(const CLI::App& verb) {
  const bool replays = verb.count("--replay") > 0;
  for (const CLI::Option* const option : verb.get_options()) {
    const std::string name = option->get_name();
    const bool of_replay = name == "--replay" || name == "--json";
    const bool is_needed = name == "--config" || name == "--duration";
    if (replays && !of_replay && !option->empty()) throw CLI::ExcludesError("--replay", name);
    if (!replays && name == "--json" && !option->empty()) throw CLI::RequiresError(name, "--replay");
    if (!replays && is_needed && option->empty()) throw CLI::RequiredError(name);
  }
}

void add_simulate(CLI::App& app, SimulateChoice& choice, Action& action) {
  haptic::simulate::SimulateOptions& options = choice.options;
  CLI::App* const verb = app.add_subcommand(
      "simulate", "Runs the tick without a clock, as fast as the machine allows, into files");
  const CLI::Validator not_negative(
      [](const std::string& text) {
        double seconds = 0.0;
        const bool good =
            CLI::detail::lexical_cast(text, seconds) && std::isfinite(seconds) && seconds >= 0.0;
        return good ? std::string() : text + " is no duration (permitted: a number of seconds from 0 on)";
      },
      "SECONDS");
  verb->add_option("--config", options.config, "the daemon's config; needed unless --replay is given");
  verb->add_option("--scene", options.scene, "the scene, instead of the config's");
  verb->add_option("--duration", options.duration,
                   "runs every tick with n / rate up to it; needed unless --replay is given")
      ->check(not_negative);
  verb->add_option("--hips-csv", options.csv.hips,
                   "each HIP in each object that holds it, forces before the guard");
  verb->add_option("--objects-csv", options.csv.objects,
                   "poses and velocities of objects, and what HIPs apply");
  verb->add_option("--devices-csv", options.csv.devices, "poses of devices, and the forces behind the guard");
  verb->add_option("--record", options.recording, "all of it as an MCAP file, as hapticctl record makes one");
  verb->add_flag("--verbose", options.verbose, "the summary tells the transitions of the constraint, too");
  verb->add_option("--replay", choice.replay.file,
                   "instead of all this, runs a recording again and compares every tick with it, to the bit: "
                   "exit code 1 if one differs");
  verb->add_flag("--json", choice.replay.json, "with --replay: one JSON object instead of text");
  verb->callback([&choice, &action, verb] {
    check_choice(*verb);
    action = [&choice] { return simulate(choice); };
  });
}

/// Reads the command line and does what it says.
int run_verb(int argc, char** argv) {
  haptic::RunOptions run;
  haptic::load::CheckOptions check;
  SimulateChoice simulate_choice;
  Action action;

  CLI::App app("Real-time haptics daemon", "hapticd");
  app.set_version_flag("--version", "hapticd " HAPTIC_VERSION);
  app.require_subcommand(1);
  app.footer("Exit codes: 0 done, 1 failed, 64 usage.");
  add_run(app, run, action);
  add_check(app, check, action);
  add_simulate(app, simulate_choice, action);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    std::fprintf(stderr, "hapticd: %s; see hapticd --help\n", error.what());
    return kUsage;
  }
  return action();
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run_verb(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "hapticd: %s\n", error.what());
    return kFailed;
  }
}
