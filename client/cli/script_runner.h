#pragma once
// Runs a script line by line over one connection, and stops at the first line that fails.

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "client/cli/background_verb.h"
#include "client/cli/script_step.h"

namespace haptic::cli {

class ScriptRunner {
 public:
  /// `name` of the script, for errors; `command` tells where the daemon is and how verbs speak.
  ScriptRunner(const Command& command, std::string name);

  /// kUsage, before anything has run, if a line is wrong; else the exit code of the line that failed, told on
  /// standard error with its place; else kDone. Having nothing to do is no failure. SIGINT and SIGTERM end it
  /// with kFailed; the daemon stays as the lines so far have left it. From the first line that arms or moves
  /// something on the script holds the drive lease until it ends: if hapticctl is killed, forces go down. To
  /// move something it goes on without the lease where it may not have it. A recording that was started ends
  /// with the script, and its failure is the script's.
  ExitCode run(const std::string& text, const Variables& defines);

 private:
  ExitCode run_steps(const std::vector<std::pair<int, Step>>& steps);
  void take_lease(const std::string& verb);
  void release_lease() noexcept;
  ExitCode run_step(const Step& step);
  ExitCode wait(double seconds);
  ExitCode wait_until(const WaitUntilStep& step);
  ExitCode expect(const ExpectStep& step);
  ExitCode run_verb(const VerbStep& step);
  ExitCode run_beside(Command verb);
  ExitCode start(const StartStep& step);
  ExitCode stop();
  ExitCode end_background();
  void pass(std::chrono::milliseconds time);
  ExitCode run_reporting(const std::function<ExitCode()>& action, int line);
  void complain(int line, const std::string& reason) const;

  const Command& command_;
  std::string name_;
  int line_ = 0;  // that runs
  int start_line_ = 0;
  std::unique_ptr<BackgroundVerb> background_;
  std::string failure_;  // why a wait or an expectation failed
};

}  // namespace haptic::cli
