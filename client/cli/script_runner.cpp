#include "client/cli/script_runner.h"

#include <fmt/format.h>
#include <poll.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <utility>

#include "client/cli/screen.h"
#include "client/lib/error.h"

namespace haptic::cli {
namespace {

using std::chrono::milliseconds;

template <typename... Functions>
struct Overloaded : Functions... {
  using Functions::operator()...;
};
template <typename... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;

constexpr milliseconds kLook{20};  // how often what runs in the background is looked after

client::Clock::time_point in(double seconds) {
  return client::Clock::now() +
         std::chrono::duration_cast<client::Clock::duration>(std::chrono::duration<double>(seconds));
}

// what is left, in pieces after which a signal is looked for
milliseconds piece_until(client::Clock::time_point deadline) {
  const auto left = std::chrono::ceil<milliseconds>(deadline - client::Clock::now());
  return std::clamp(left, milliseconds(0), milliseconds(100));
}

// what works on files
bool needs_no_daemon(std::string_view verb) {
  constexpr std::array<std::string_view, 5> kVerbs{"export", "info", "plot", "recover", "replay"};
  return std::find(kVerbs.begin(), kVerbs.end(), verb) != kVerbs.end();
}

}  // namespace

ScriptRunner::ScriptRunner(const Command& command, std::string name)
    : command_(command), name_(std::move(name)) {}

ExitCode ScriptRunner::run(const std::string& text, const Variables& defines) {
  std::vector<std::pair<int, Step>> steps;
  try {
    for (const ScriptLine& line : read_script(text, defines)) {
      steps.emplace_back(line.line, make_step(line));
    }
  } catch (const ScriptError& error) {
    complain(error.line(), error.what());
    return kUsage;
  }
  catch_stop_signals();
  const ExitCode code = run_steps(steps);
  const ExitCode end = end_background();
  release_lease();
  return code == kDone ? end : code;
}

ExitCode ScriptRunner::run_steps(const std::vector<std::pair<int, Step>>& steps) {
  for (const auto& [line, step] : steps) {
    line_ = line;
    const ExitCode code = run_reporting([this, &step = step] { return run_step(step); }, line);
    if (stop_requested()) {
      complain(line, "stopped by a signal");
      return kFailed;
    }
    if (code != kDone) {
      return code;
    }
  }
  return kDone;
}

// the code of the line, kDone where it had nothing to do
ExitCode ScriptRunner::run_reporting(const std::function<ExitCode()>& action, int line) {
  failure_.clear();
  ExitCode code = kFailed;
  try {
    code = action();
  } catch (const client::Error& error) {
    code = exit_code(error);
    failure_ = error.what();
  } catch (const std::exception& error) {
    failure_ = error.what();
  }
  if (code != kDone && !stop_requested()) {
    complain(line, failure_.empty() ? fmt::format("exit code {}", static_cast<int>(code)) : failure_);
  }
  return code == kNothingToDo ? kDone : code;
}

ExitCode ScriptRunner::run_step(const Step& step) {
  return std::visit(
      Overloaded{[this](const WaitStep& s) { return wait(s.seconds); },
                 [this](const WaitUntilStep& s) { return wait_until(s); },
                 [this](const ExpectStep& s) { return expect(s); },
                 [](const EchoStep& s) {
                   fmt::print("{}\n", s.text);
                   std::fflush(stdout);
                   return kDone;
                 },
                 [this](const StartStep& s) { return start(s); }, [this](const StopStep&) { return stop(); },
                 [this](const VerbStep& s) { return run_verb(s); }},
      step);
}

ExitCode ScriptRunner::wait(double seconds) {
  const client::Clock::time_point deadline = in(seconds);
  while (!stop_requested() && client::Clock::now() < deadline) {
    pass(piece_until(deadline));
  }
  return kDone;
}

// events are taken, so that they do not heap up; heartbeats go out, and a daemon that goes away is noticed
void ScriptRunner::pass(milliseconds time) {
  if (*command_.connection) {
    (*command_.connection)->receive(time);
  } else {
    ::poll(nullptr, 0, static_cast<int>(time.count()));
  }
}

ExitCode ScriptRunner::wait_until(const WaitUntilStep& step) {
  const client::Clock::time_point deadline = in(step.seconds);
  Lookout lookout(command_.connect(), topic_of(step.condition));
  std::optional<double> last;
  while (!stop_requested() && (!last || client::Clock::now() < deadline)) {
    const std::optional<Look> look = lookout.next(piece_until(deadline));
    if (look) {
      last = measure(step.condition, *look);
      if (holds(step.condition, *last)) {
        return kDone;
      }
    } else if (client::Clock::now() >= deadline) {
      break;
    }
  }
  failure_ = fmt::format("{} did not come true within {} s; {}", step.condition.text, step.seconds,
                         last ? fmt::format("it is {:.6g}", *last) : "no frames came");
  return kFailed;
}

ExitCode ScriptRunner::expect(const ExpectStep& step) {
  const Look look = look_once(command_.connect(), topic_of(step.condition));
  const double measured = measure(step.condition, look);
  if (holds(step.condition, measured)) {
    return kDone;
  }
  failure_ = fmt::format("expected {}; it is {:.6g}", step.condition.text, measured);
  return kFailed;
}

ExitCode ScriptRunner::run_verb(const VerbStep& step) {
  Command verb = command_;
  parse_verb(step.words, verb);
  take_lease(step.verb);
  const ExitCode code = needs_no_daemon(step.verb) ? run_beside(std::move(verb)) : verb.action(verb);
  std::fflush(stdout);
  return code;
}

// heartbeats go out while a long file is worked on
ExitCode ScriptRunner::run_beside(Command verb) {
  BackgroundVerb running(std::move(verb));
  while (!running.has_ended_within(milliseconds(0))) {
    pass(kLook);
  }
  return running.result();
}

ExitCode ScriptRunner::start(const StartStep& step) {
  if (background_) {
    failure_ = "something is recorded already";
    return kFailed;
  }
  Command verb = command_;
  parse_verb(step.words, verb);
  start_line_ = line_;
  background_ = std::make_unique<BackgroundVerb>(std::move(verb));
  while (!background_->has_begun_within(milliseconds(0)) && !stop_requested()) {
    pass(kLook);
  }
  // one that has ended by now could not begin, or had nothing more to do
  return background_->has_ended_within(milliseconds(0)) ? stop() : kDone;
}

ExitCode ScriptRunner::stop() {
  if (!background_) {
    failure_ = "nothing is recorded";
    return kFailed;
  }
  const std::unique_ptr<BackgroundVerb> ending = std::move(background_);
  ending->stop();
  while (!ending->has_ended_within(milliseconds(0))) {
    pass(kLook);
  }
  return ending->result();
}

ExitCode ScriptRunner::end_background() {
  if (!background_) {
    return kDone;
  }
  return run_reporting([this] { return stop(); }, start_line_);
}

void ScriptRunner::take_lease(const std::string& verb) {
  const bool arms = verb == "arm";
  const bool moves = verb == "object move" || verb == "device move";
  if ((!arms && !moves) || command_.connect().holds_drive()) {
    return;
  }
  try {
    command_.connect().acquire_drive();
  } catch (const client::Unsupported&) {
    return;  // a daemon that has no leases
  } catch (const client::Refused&) {
    if (arms) {
      throw;
    }
  }
}

void ScriptRunner::release_lease() noexcept {
  try {
    if (*command_.connection) {
      (*command_.connection)->release_drive();
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: the drive lease could not be released: %s\n", name_.c_str(), error.what());
  }
}

void ScriptRunner::complain(int line, const std::string& reason) const {
  std::fflush(stdout);
  fmt::print(stderr, "{}:{}: {}\n", name_, line, reason);
}

}  // namespace haptic::cli
