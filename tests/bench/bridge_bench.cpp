// What a broker makes of the one client that the daemon sees: starts hapticd, nats-server and haptic-bridge
// on this machine, lets subscribers in numbers listen to the objects, and tells what reached them, how late,
// what it cost each of the three, and what became of the daemon's ticks.
//
// usage: bridge_bench HAPTICD HAPTIC_BRIDGE CONFIG [--seconds N] [--json FILE]      N: of each phase, 5

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iostream>

#include "tests/bench/load_daemon.h"
#include "tests/bench/nats_swarm.h"
#include "tests/support/nats_server.h"

namespace haptic::bench {
namespace {

constexpr const char* kSubject = "haptic.bench.objects";

struct Phase {
  std::string name;
  std::size_t subscribers = 0;
  std::uint32_t decimation = 1;
};

class BridgeProcess {
 public:
  BridgeProcess(const std::string& program, const std::string& socket, const std::string& url,
                std::uint32_t decimation) {
    const std::string ticks = std::to_string(decimation);
    process_ = ::fork();
    if (process_ == 0) {
      ::dup2(::open("/dev/null", O_WRONLY), STDERR_FILENO);
      ::execl(program.c_str(), program.c_str(), "--socket", socket.c_str(), "--url", url.c_str(), "--host",
              "bench", "--topic", "objects", "--decimation", ticks.c_str(), "--lossless", nullptr);
      ::_exit(127);
    }
  }
  BridgeProcess(const BridgeProcess&) = delete;
  BridgeProcess& operator=(const BridgeProcess&) = delete;
  ~BridgeProcess() {
    ::kill(process_, SIGTERM);
    ::waitpid(process_, nullptr, 0);
  }
  pid_t process() const noexcept { return process_; }

 private:
  pid_t process_ = -1;
};

struct Figures {
  double seconds = 0.0;
  Arrivals arrivals{};
  std::size_t cut_off = 0;
  std::uint64_t missed_ticks = 0;
  double daemon_cpu = 0.0;  // parts of one core
  double bridge_cpu = 0.0;
  double broker_cpu = 0.0;
};

Figures run(const Phase& phase, const LoadDaemon& daemon, const std::string& program, double seconds) {
  const test::NatsServer server;
  const BridgeProcess bridge(program, daemon.socket(), server.url(), phase.decimation);
  if (!test::NatsListener(server.url(), "haptic.bench.scene")
           .next("haptic.bench.scene", std::chrono::seconds(20))) {
    throw std::runtime_error(program + " publishes nothing");
  }
  NatsSwarm swarm(server.address(), phase.subscribers, kSubject);
  const std::uint64_t missed = daemon.missed_ticks();
  Figures figures;
  const double daemon_cpu = daemon.cpu_seconds();
  const double bridge_cpu = cpu_seconds_of(bridge.process());
  const double broker_cpu = cpu_seconds_of(server.process());
  const auto start = client::Clock::now();
  swarm.read_for(std::chrono::duration<double>(seconds));
  const double whole = std::chrono::duration<double>(client::Clock::now() - start).count();
  figures.seconds = seconds;
  figures.daemon_cpu = (daemon.cpu_seconds() - daemon_cpu) / whole;
  figures.bridge_cpu = (cpu_seconds_of(bridge.process()) - bridge_cpu) / whole;
  figures.broker_cpu = (cpu_seconds_of(server.process()) - broker_cpu) / whole;
  figures.missed_ticks = daemon.missed_ticks() - missed;
  figures.arrivals = swarm.arrivals();
  figures.cut_off = swarm.cut_off();
  return figures;
}

double per_second(const Figures& f) {
  return static_cast<double>(f.arrivals.latencies_ns.size()) / f.seconds;
}

double lost_percent(const Figures& f) {
  const auto lost = static_cast<double>(f.arrivals.lost);
  const auto all = lost + static_cast<double>(f.arrivals.latencies_ns.size());
  return all > 0.0 ? 100.0 * lost / all : 0.0;
}

std::string row(const Phase& phase, const Figures& f) {
  const auto ms = [](std::uint64_t nanoseconds) { return static_cast<double>(nanoseconds) / 1e6; };
  return fmt::format("{:30} {:12.0f} {:8.3f} {:8.2f} {:8.2f} {:7} {:9} {:8.1f} {:7.1f} {:7.1f}", phase.name,
                     per_second(f), lost_percent(f), ms(f.arrivals.latency(0.5)),
                     ms(f.arrivals.latency(0.99)), f.cut_off, f.missed_ticks, 100.0 * f.daemon_cpu,
                     100.0 * f.bridge_cpu, 100.0 * f.broker_cpu);
}

std::string json(const Phase& phase, const Figures& f) {
  return fmt::format(
      R"({{"name":"{}","subscribers":{},"decimation":{},"seconds":{:.3f},"frames":{},"lost_frames":{},)"
      R"("latency_p50_ns":{},"latency_p99_ns":{},"cut_off":{},"missed_ticks":{},"daemon_cpu":{:.4f},)"
      R"("bridge_cpu":{:.4f},"broker_cpu":{:.4f}}})",
      phase.name, phase.subscribers, phase.decimation, f.seconds, f.arrivals.latencies_ns.size(),
      f.arrivals.lost, f.arrivals.latency(0.5), f.arrivals.latency(0.99), f.cut_off, f.missed_ticks,
      f.daemon_cpu, f.bridge_cpu, f.broker_cpu);
}

// a socket for each subscriber, in this process and in the broker
void allow_many_files() {
  rlimit limit{};
  ::getrlimit(RLIMIT_NOFILE, &limit);
  limit.rlim_cur = limit.rlim_max;
  ::setrlimit(RLIMIT_NOFILE, &limit);
}

int measure(const std::string& hapticd, const std::string& bridge, const std::string& config, double seconds,
            const char* json_file) {
  const std::vector<Phase> phases = {
      {.name = "nobody, each tick"},
      {.name = "1, each tick", .subscribers = 1},
      {.name = "1000, each 100th tick", .subscribers = 1000, .decimation = 100},
      {.name = "1000, each 20th tick", .subscribers = 1000, .decimation = 20},
      {.name = "1000, each tick", .subscribers = 1000},
  };
  allow_many_files();
  const LoadDaemon daemon(hapticd, config);
  fmt::print("{:30} {:>12} {:>8} {:>17} {:>7} {:>9} {:>24}\n", "subscribers", "delivered/s", "lost %",
             "arrival ms p50/p99", "cut off", "missed", "CPU % daemon/bridge/broker");
  std::string all;
  for (const Phase& phase : phases) {
    const Figures figures = run(phase, daemon, bridge, seconds);
    fmt::print("{}\n", row(phase, figures));
    std::fflush(stdout);
    all += (all.empty() ? "" : ",\n") + json(phase, figures);
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
  for (int i = 4; i + 1 < argc; i += 2) {
    if (std::strcmp(argv[i], "--seconds") == 0) {
      seconds = std::atof(argv[i + 1]);
    } else if (std::strcmp(argv[i], "--json") == 0) {
      json_file = argv[i + 1];
    }
  }
  if (argc < 4 || argc % 2 != 0 || !(seconds > 0.0)) {
    std::cerr << "usage: bridge_bench HAPTICD HAPTIC_BRIDGE CONFIG [--seconds N] [--json FILE]\n";
    return 64;
  }
  try {
    return haptic::bench::measure(argv[1], argv[2], argv[3], seconds, json_file);
  } catch (const std::exception& error) {
    std::cerr << "bridge_bench: " << error.what() << "\n";
    return 1;
  }
}
