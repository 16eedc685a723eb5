// What clients cost: starts `hapticd run` on the grasp scene and tells, for several crowds of clients and for
// none, how many ticks were missed, how long a tick worked, how late frames arrived, and what a client costs
// in bytes and CPU. Ratios between the rows of one run say more than the numbers of one machine.
//
// usage: load_bench HAPTICD CONFIG [--seconds N] [--json FILE]      N: of each phase, 5

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iostream>

#include "tests/bench/load_clients.h"
#include "tests/bench/load_daemon.h"

namespace haptic::bench {
namespace {

struct Figures {
  std::string name;
  std::size_t clients = 0;  // that read frames
  double seconds = 0.0;
  v1::Stats stats{};
  double cpu_seconds = 0.0;  // of the daemon
  Arrivals arrivals{};
  std::uint64_t deeds = 0;  // reconnects, or commands answered
};

struct Phase {
  std::string name;
  std::size_t clients = 0;
  std::uint32_t decimation = 1;
  std::size_t stalled = 0;
  enum class Nuisance { kNone, kReconnect, kFlood } nuisance = Nuisance::kNone;
};

const v1::Histogram& whole_tick(const v1::Stats& stats) {
  static const v1::Histogram kNone;
  for (const v1::Histogram& stage : stats.stage()) {
    if (stage.name() == "tick") {
      return stage;
    }
  }
  return kNone;
}

Figures run(const Phase& phase, LoadDaemon& daemon, double seconds) {
  Figures figures{.name = phase.name, .clients = phase.clients - phase.stalled};
  Swarm swarm(daemon.socket(), phase.clients, phase.decimation, phase.stalled);
  Nuisance nuisance(daemon.socket());
  daemon.stats(true);
  const std::uint64_t missed_before = daemon.missed_ticks();
  const double cpu = daemon.cpu_seconds();
  const auto start = client::Clock::now();
  if (phase.nuisance == Phase::Nuisance::kReconnect) {
    nuisance.reconnect(10'000);
  } else if (phase.nuisance == Phase::Nuisance::kFlood) {
    nuisance.flood();
  }
  swarm.read_for(std::chrono::duration<double>(seconds));
  figures.seconds = std::chrono::duration<double>(client::Clock::now() - start).count();
  figures.deeds = nuisance.stop();
  figures.cpu_seconds = daemon.cpu_seconds() - cpu;
  figures.stats = daemon.stats(false);
  // a reset is done some ticks after it is answered
  figures.stats.set_missed_ticks(daemon.missed_ticks() - missed_before);
  figures.arrivals = swarm.arrivals();
  return figures;
}

std::string row(const Figures& f) {
  const v1::Histogram& tick = whole_tick(f.stats);
  const auto us = [](std::uint64_t nanoseconds) { return static_cast<double>(nanoseconds) / 1e3; };
  const double readers = static_cast<double>(std::max<std::size_t>(f.clients, 1));
  return fmt::format(
      "{:28} {:7} {:8.1f} {:8.1f} {:9.1f} {:8.0f} {:8.0f} {:8.0f} {:10.1f} {:8.2f} {:8.3f} {:6} {:8}", f.name,
      f.stats.missed_ticks(), us(tick.p50_ns()), us(tick.p99_ns()), us(tick.max_ns()),
      us(f.arrivals.latency(0.5)), us(f.arrivals.latency(0.99)), us(f.arrivals.latency(0.999)),
      static_cast<double>(f.arrivals.bytes) / f.seconds / readers / 1e3, 100.0 * f.cpu_seconds / f.seconds,
      100.0 * f.cpu_seconds / f.seconds / readers, f.arrivals.lost, f.deeds);
}

std::string json(const Figures& f) {
  const v1::Histogram& tick = whole_tick(f.stats);
  return fmt::format(
      R"({{"name":"{}","clients":{},"seconds":{:.3f},"missed_ticks":{},"tick_p50_ns":{},"tick_p99_ns":{},)"
      R"("tick_max_ns":{},"latency_p50_ns":{},"latency_p99_ns":{},"latency_p999_ns":{},"frames":{},"bytes":{},)"
      R"("lost_frames":{},"daemon_cpu_s":{:.3f},"deeds":{}}})",
      f.name, f.clients, f.seconds, f.stats.missed_ticks(), tick.p50_ns(), tick.p99_ns(), tick.max_ns(),
      f.arrivals.latency(0.5), f.arrivals.latency(0.99), f.arrivals.latency(0.999),
      f.arrivals.latencies_ns.size(), f.arrivals.bytes, f.arrivals.lost, f.cpu_seconds, f.deeds);
}

int measure(const std::string& program, const std::string& config, double seconds, const char* json_file) {
  const std::vector<Phase> phases = {
      {.name = "nobody"},
      {.name = "32 at each tick", .clients = 32},
      {.name = "200 at each 17th tick", .clients = 200, .decimation = 17},
      {.name = "32, one of them stalled", .clients = 32, .stalled = 1},
      {.name = "1, and reconnects", .clients = 1, .nuisance = Phase::Nuisance::kReconnect},
      {.name = "1, and a flood of commands", .clients = 1, .nuisance = Phase::Nuisance::kFlood},
      {.name = "nobody again"},
  };
  LoadDaemon daemon(program, config);
  fmt::print("{:28} {:>7} {:>26} {:>26} {:>10} {:>17} {:>6} {:>8}\n", "", "missed", "tick us p50/p99/max",
             "arrival us p50/p99/p99.9", "kB/s each", "CPU % all/each", "lost", "deeds");
  std::string all;
  for (const Phase& phase : phases) {
    const Figures figures = run(phase, daemon, seconds);
    fmt::print("{}\n", row(figures));
    std::fflush(stdout);
    all += (all.empty() ? "" : ",\n") + json(figures);
  }
  if (json_file != nullptr) {
    std::ofstream(json_file) << "{\"phases\":[\n" << all << "\n]}\n";
  }
  return 0;
}

}  // namespace
}  // namespace haptic::bench

int main(int argc, char** argv) {
  double seconds = 5.0;
  const char* json_file = nullptr;
  for (int i = 3; i + 1 < argc; i += 2) {
    if (std::strcmp(argv[i], "--seconds") == 0) {
      seconds = std::atof(argv[i + 1]);
    } else if (std::strcmp(argv[i], "--json") == 0) {
      json_file = argv[i + 1];
    }
  }
  if (argc < 3 || argc % 2 == 0 || !(seconds > 0.0)) {
    std::cerr << "usage: load_bench HAPTICD CONFIG [--seconds N] [--json FILE]\n";
    return 64;
  }
  try {
    return haptic::bench::measure(argv[1], argv[2], seconds, json_file);
  } catch (const std::exception& error) {
    std::cerr << "load_bench: " << error.what() << "\n";
    return 1;
  }
}
