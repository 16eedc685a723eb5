#include <fmt/format.h>
#include <google/protobuf/struct.pb.h>

#include <system_error>

#include "client/cli/describe.h"
#include "client/cli/screen.h"
#include "client/cli/verbs.h"
#include "client/latency/latency.h"
#include "client/latency/latency_report.h"

namespace haptic::cli {
namespace {

constexpr std::size_t kBarWidth = 40;

struct LatencyOptions {
  double seconds = 60.0;
  double rate_hz = 1000.0;
  std::uint32_t priority = 80;
  std::optional<unsigned> cpu;
  bool awake = false;
};

struct Figure {
  const char* name;  // of JSON, ns
  const char* told;
  double ns;
};

std::vector<Figure> figures_of(const latency::Latenesses& times) {
  const auto& all = times.histogram();
  const auto ns = [](std::uint64_t value) { return static_cast<double>(value); };
  return {{"min_ns", "min", ns(times.min_ns())},
          {"mean_ns", "mean", all.mean_ns()},
          {"p50_ns", "p50", ns(all.quantile_ns(0.5))},
          {"p99_ns", "p99", ns(all.quantile_ns(0.99))},
          {"p999_ns", "p99.9", ns(all.quantile_ns(0.999))},
          {"max_ns", "max", ns(all.max_ns())}};
}

void print_as_json(const LatencyOptions& options, const latency::Measured& measured) {
  google::protobuf::Struct message;
  auto& fields = *message.mutable_fields();
  fields["rate_hz"].set_number_value(options.rate_hz);
  fields["seconds"].set_number_value(measured.seconds);
  fields["count"].set_number_value(static_cast<double>(measured.times.histogram().total()));
  fields["missed"].set_number_value(static_cast<double>(measured.missed));
  for (const Figure& figure : figures_of(measured.times)) {
    fields[figure.name].set_number_value(figure.ns);
  }
  fields["fifo"].set_bool_value(measured.rights.fifo);
  fields["priority"].set_number_value(measured.rights.priority);
  fields["memory_locked"].set_bool_value(measured.rights.memory_locked);
  fields["awake"].set_bool_value(measured.is_awake);
  auto& warnings = *fields["warning"].mutable_list_value();
  for (const std::string& warning : measured.rights.warnings) {
    warnings.add_values()->set_string_value(warning);
  }
  auto& bins = *fields["histogram"].mutable_list_value();
  for (std::size_t i = 0; i < measured.times.bins().size(); ++i) {
    auto& bin = *bins.add_values()->mutable_struct_value()->mutable_fields();
    if (i < latency::kBinEnds.size()) {
      bin["up_to_ns"].set_number_value(static_cast<double>(latency::kBinEnds[i]));
    }
    bin["count"].set_number_value(static_cast<double>(measured.times.bins()[i]));
  }
  print_json(message);
}

void print_text(const LatencyOptions& options, const latency::Measured& measured) {
  const rt::RealtimeReport& rights = measured.rights;
  fmt::print(
      "{:.6g} Hz for {:.1f} s, {}{}{}{}\n", options.rate_hz, measured.seconds,
      rights.fifo ? fmt::format("SCHED_FIFO {}", rights.priority) : std::string("no real-time priority"),
      rights.memory_locked ? ", memory locked" : "", rights.cpu ? fmt::format(", CPU {}", *rights.cpu) : "",
      measured.is_awake ? ", cores held awake" : "");
  for (const std::string& warning : rights.warnings) {
    fmt::print("  {}\n", warning);
  }
  fmt::print("{}, {}\n\nlateness ", count_of(measured.times.histogram().total(), "wake-up"),
             count_of(measured.missed, "missed period"));
  for (const Figure& figure : figures_of(measured.times)) {
    fmt::print(" {} {} ", figure.told, latency::in_words(figure.ns));
  }
  fmt::print("\n\nup to       wake-ups  (bars are logarithmic)\n{}",
             latency::draw(measured.times, kBarWidth));
}

ExitCode measure_latency(const Command& command, const LatencyOptions& options) {
  catch_stop_signals();
  const latency::Settings settings{
      .rate_hz = options.rate_hz,
      .duration = std::chrono::duration<double>(options.seconds),
      .thread = {.priority = static_cast<int>(options.priority), .cpu = options.cpu, .lock_memory = true},
      .awake = options.awake};
  try {
    const latency::Measured measured = latency::measure(settings, [] { return stop_requested(); });
    if (command.json) {
      print_as_json(options, measured);
    } else {
      print_text(options, measured);
    }
    return kDone;
  } catch (const std::system_error& error) {
    fmt::print(stderr, "hapticctl: {}\n", error.what());
    return kFailed;
  }
}

}  // namespace

void add_latency(CLI::App& app, Command& command) {
  const auto options = std::make_shared<LatencyOptions>();
  CLI::App& verb =
      add_verb(app, command, "latency", "measure how late a real-time thread wakes up on this machine",
               [options](const Command& chosen) { return measure_latency(chosen, *options); });
  add_option(verb, "--seconds", options->seconds, "how long; a signal ends it before; default: 60")
      .between(0.01, 1e6)
      .type("SECONDS");
  add_option(verb, "--rate", options->rate_hz, "wake-ups in a second; default: 1000")
      .between(100.0, 8000.0)
      .type("HZ");
  add_option(verb, "--priority", options->priority, "of SCHED_FIFO; default: 80, the servo thread's")
      .between(std::uint32_t{1}, std::uint32_t{99})
      .type("1..99");
  add_count(verb, "--cpu", "the core that it is bound to; default: any", [options](std::uint32_t cpu) {
    options->cpu = cpu;
  }).type("NUMBER");
  add_flag(verb, "--awake", options->awake,
           "hold cores out of deep sleep meanwhile, as the daemon does while it is armed");
}

}  // namespace haptic::cli
