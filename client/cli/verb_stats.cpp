#include <fmt/format.h>

#include <array>
#include <map>
#include <memory>
#include <optional>

#include "client/cli/describe.h"
#include "client/cli/table.h"
#include "client/cli/verbs.h"
#include "client/lib/error.h"
#include "proto/metrics/exposition.h"

namespace haptic::cli {
namespace {

constexpr int kStates = 5;

void add_histogram(Table& table, const std::string& name, const v1::Histogram& times) {
  const auto cell = [&](double ns) { return times.total() == 0 ? std::string("-") : nanoseconds(ns); };
  const auto quantile = [&](std::uint64_t ns) { return cell(static_cast<double>(ns)); };
  table.add({name, fmt::format("{}", times.total()), cell(times.mean_ns()), quantile(times.p50_ns()),
             quantile(times.p99_ns()), quantile(times.p999_ns()), quantile(times.max_ns())});
}

// "-" for a transition that there is not, "0" for one that has not been made
std::string transitions(const v1::Stats& stats) {
  std::array<std::array<std::string, kStates>, kStates> cells;
  for (auto& row : cells) {
    row.fill("-");
  }
  for (const v1::TransitionStats& transition : stats.transition()) {
    const auto before = static_cast<std::size_t>(transition.before());
    const auto after = static_cast<std::size_t>(transition.after());
    if (before >= kStates || after >= kStates) {
      continue;
    }
    std::string& cell = cells[before][after];
    cell = fmt::format("{}", transition.count());
    if (transition.mean_ns() > 0.0) {
      cell += " x " + nanoseconds(transition.mean_ns());
    }
  }
  Table table({{"from \\ to", Align::kLeft}, {"Tet"}, {"Sur"}, {"Edg"}, {"Ver"}, {"Out"}});
  for (int before = 0; before < kStates; ++before) {
    const auto& row = cells[static_cast<std::size_t>(before)];
    table.add({name_of(static_cast<v1::ConstraintState>(before)), row[0], row[1], row[2], row[3], row[4]});
  }
  return table.to_string();
}

constexpr int kMostFaults = 100;  // that the daemon tells of

// an older daemon does not count them
std::optional<std::map<v1::FaultKind, std::uint64_t>> ask_faults(client::Connection& daemon) {
  try {
    const v1::Response response = call(daemon, [](v1::Request& request) { request.mutable_list_faults(); });
    return metrics::count_faults(response.faults(), kMostFaults);
  } catch (const client::Unsupported&) {
    return std::nullopt;
  }
}

void print_prometheus(client::Connection& daemon, const v1::Stats& stats) {
  const v1::Response status = call(daemon, [](v1::Request& request) { request.mutable_get_status(); });
  const v1::Response devices = call(daemon, [](v1::Request& request) { request.mutable_list_devices(); });
  fmt::print("{}", metrics::exposition({.status = status.status(),
                                        .devices = devices.devices(),
                                        .stats = stats,
                                        .faults = ask_faults(daemon)}));
}

struct StatsOptions {
  bool reset = false;
  bool prometheus = false;
};

ExitCode show_stats(Command& command, const StatsOptions& options) {
  client::Connection& daemon = command.connect();
  const v1::Response response =
      call(daemon, [&](v1::Request& request) { request.mutable_get_stats()->set_reset(options.reset); });
  const v1::Stats& stats = response.stats();
  if (options.prometheus) {
    print_prometheus(daemon, stats);
    return kDone;
  }
  if (command.json) {
    print_json(stats);
    return kDone;
  }
  fmt::print("{:.6g} Hz, tick {}, {} missed, {} lost on the way to clients\n\n", stats.rate_hz(),
             stats.tick(), count_of(stats.missed_ticks(), "tick"),
             count_of(stats.lost_snapshots(), "snapshot"));
  Table times({{"time of", Align::kLeft}, {"count"}, {"mean"}, {"p50"}, {"p99"}, {"p99.9"}, {"max"}});
  add_histogram(times, "wake-up", stats.wakeup());
  for (const v1::Histogram& stage : stats.stage()) {
    add_histogram(times, stage.name(), stage);
  }
  fmt::print("{}\ntransitions of HIPs, count x mean time\n{}", times.to_string(), transitions(stats));
  if (stats.relocations() > 0 || stats.limited_hips() > 0) {
    fmt::print("\n{} out of a circle, {} stopped at the limit of transitions in one tick\n",
               count_of(stats.relocations(), "relocation"), count_of(stats.limited_hips(), "HIP"));
  }
  return kDone;
}

}  // namespace

void add_stats(CLI::App& app, Command& command) {
  const auto options = std::make_shared<StatsOptions>();
  CLI::App& verb = add_verb(app, command, "stats", "how long ticks take, and what HIPs do in them",
                            [options](Command& chosen) { return show_stats(chosen, *options); });
  add_flag(verb, "--reset", options->reset, "start to count anew after this");
  add_flag(verb, "--prometheus", options->prometheus,
           "all numbers of the daemon in the text format of Prometheus");
}

}  // namespace haptic::cli
