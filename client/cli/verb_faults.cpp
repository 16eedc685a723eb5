#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>

#include "client/cli/advice.h"
#include "client/cli/describe.h"
#include "client/cli/verbs.h"

namespace haptic::cli {
namespace {

constexpr std::uint64_t kNanoseconds = 1'000'000'000;  // in a second

// "2026-11-21 16:23:19.123", local time
std::string moment(std::uint64_t realtime_ns) {
  const auto seconds = static_cast<std::time_t>(realtime_ns / kNanoseconds);
  std::tm local{};
  if (::localtime_r(&seconds, &local) == nullptr) {
    return "-";
  }
  return fmt::format("{:%F %T}.{:03}", local, realtime_ns % kNanoseconds / 1'000'000);
}

void print(const v1::FaultList::FaultRecord& record) {
  fmt::print("{}  {}{}\n", moment(record.realtime_ns()), describe(record.fault()),
             record.latched() ? ", LATCHED" : "");
  fmt::print("    {}\n", advise(record.fault().kind()));
  if (!record.recording().empty()) {
    fmt::print("    what came before: {}\n", record.recording());
  }
}

ExitCode show_faults(Command& command) {
  client::Connection& daemon = command.connect();
  const v1::Response response = call(daemon, [](v1::Request& request) { request.mutable_list_faults(); });
  const v1::FaultList& faults = response.faults();
  bool is_latched = false;
  for (const v1::FaultList::FaultRecord& record : faults.fault()) {
    is_latched = is_latched || record.latched();
    if (command.json) {
      print_json(record);
    } else {
      print(record);
    }
  }
  if (command.json) {
    return kDone;
  }
  if (faults.fault().empty()) {
    fmt::print("no fault since the daemon's start\n");
  } else if (is_latched) {
    fmt::print("forces stay zero until the cause is gone and somebody says: hapticctl clear\n");
  }
  return kDone;
}

}  // namespace

void add_faults(CLI::App& app, Command& command) {
  add_verb(app, command, "faults", "the faults since the daemon's start, and what to do about each",
           show_faults);
}

}  // namespace haptic::cli
