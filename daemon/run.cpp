#include "daemon/run.h"

#include <csignal>
// Boost.Asio of Debian 12 needs it before
#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include "daemon/scene_builder.h"
#include "ipc/server.h"
#include "load/config_file.h"
#include "rt/cpu_latency.h"
#include "rt/tick_clock.h"
#include "servo/servo_loop.h"
#include "servo/servo_thread.h"
#include "setup/device_set.h"
#include "setup/settings.h"

namespace haptic {

namespace {

constexpr std::uint64_t kFirstRevision = 1;

/// The level as journald reads it at the beginning of a line: "<4>" for a warning.
class JournalLevel final : public spdlog::custom_flag_formatter {
 public:
  void format(const spdlog::details::log_msg& message, const std::tm& /*time*/,
              spdlog::memory_buf_t& line) override {
    const char* level = "<6>";
    if (message.level == spdlog::level::debug || message.level == spdlog::level::trace) level = "<7>";
    if (message.level == spdlog::level::warn) level = "<4>";
    if (message.level >= spdlog::level::err) level = "<3>";
    line.append(level, level + 3);
  }
  std::unique_ptr<spdlog::custom_flag_formatter> clone() const override {
    return std::make_unique<JournalLevel>();
  }
};

void begin_log(bool foreground) {
  const auto logger =
      std::make_shared<spdlog::logger>("hapticd", std::make_shared<spdlog::sinks::stderr_color_sink_mt>());
  if (foreground) {
    logger->set_pattern("%H:%M:%S.%e %^%l%$ %v");
  } else {
    auto formatter = std::make_unique<spdlog::pattern_formatter>();
    formatter->add_flag<JournalLevel>('*').set_pattern("%*%v");
    logger->set_formatter(std::move(formatter));
  }
  logger->flush_on(spdlog::level::info);
  spdlog::set_default_logger(logger);
}

/// SIGINT and SIGTERM. Made before any thread, so that all inherit the mask and none is interrupted.
class StopSignals {
 public:
  StopSignals() {
    sigemptyset(&signals_);
    sigaddset(&signals_, SIGINT);
    sigaddset(&signals_, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
    std::signal(SIGPIPE, SIG_IGN);
  }

  void wait() const {
    int signal = 0;
    sigwait(&signals_, &signal);
  }

 private:
  sigset_t signals_{};
};

/// Waits on a thread of its own and calls `stop` once: at the first signal, or in the end.
class StopWaiter {
 public:
  StopWaiter(const StopSignals& signals, std::function<void()> stop)
      : thread_([&signals, call = std::move(stop)] {
          signals.wait();
          call();
        }) {}
  ~StopWaiter() {
    pthread_kill(thread_.native_handle(), SIGINT);
    thread_.join();
  }
  StopWaiter(const StopWaiter&) = delete;
  StopWaiter& operator=(const StopWaiter&) = delete;

 private:
  std::thread thread_;
};

std::vector<v1::DeviceDescription> describe_devices(const setup::DeviceSet& devices, double max_force) {
  std::vector<v1::DeviceDescription> descriptions;
  for (const drivers::Device* const device : devices.devices()) {
    v1::DeviceDescription& told = descriptions.emplace_back();
    told.set_name(device->info().name);
    told.set_driver(device->info().driver);
    told.set_max_force(std::min(device->info().max_force, max_force));
  }
  return descriptions;
}

ipc::PlaceDevice place_with(drivers::VirtualDevice* device) {
  if (device == nullptr) return {};
  return [device](const ipc::DevicePlace& place) -> ipc::LiveForce {
    device->place({.time = place.time_ns,
                   .position = place.position,
                   .orientation = place.orientation,
                   .velocity = place.velocity.value_or(glm::dvec3(0.0)),
                   .buttons = place.buttons},
                  place.velocity.has_value());
    const drivers::ForceCommand force = device->live_force(rt::monotonic_ns());
    return {.expires_ns = force.expires, .force = force.force, .torque = force.torque};
  };
}

std::vector<ipc::PlaceDevice> places_of(const setup::DeviceSet& devices) {
  std::vector<ipc::PlaceDevice> places;
  places.reserve(devices.names().size());
  for (std::size_t i = 0; i < devices.names().size(); ++i) {
    places.push_back(place_with(devices.find_virtual(i)));
  }
  return places;
}

v1::RealTime describe_rights(const rt::RealtimeReport& report) {
  v1::RealTime told;
  told.set_fifo(report.fifo);
  told.set_priority(static_cast<std::uint32_t>(report.priority));
  told.set_memory_locked(report.memory_locked);
  if (report.cpu) told.set_cpu(*report.cpu);
  for (const std::string& warning : report.warnings) told.add_warning(warning);
  return told;
}

void log_rights(const rt::RealtimeReport& report) {
  if (report.fifo) spdlog::info("the servo thread has real-time priority {} (SCHED_FIFO)", report.priority);
  for (const std::string& warning : report.warnings) spdlog::warn("not granted: {}", warning);
  if (!report.warnings.empty()) spdlog::warn("the daemon runs without it, and ticks may be late");
}

void keep_awake(rt::CpuLatency& cores, bool armed) {
  if (!armed) return cores.release();
  if (const std::string warning = cores.hold(); !warning.empty()) spdlog::warn("{}", warning);
}

ipc::ServerSettings server_settings(const RunOptions& options, const v1::DaemonConfig& config) {
  ipc::ServerSettings settings = ipc::server_settings(config);
  if (!options.socket.empty()) {
    settings.listen.clear();
    settings.listen.emplace_back().mutable_unix()->set_path(options.socket);
  }
  return settings;
}

}  // namespace

void run(const RunOptions& options) {
  begin_log(options.foreground);
  const StopSignals signals;

  // what is written in files
  const load::LoadedConfig config = load::load_config(options.config);
  setup::DeviceSet devices(config);
  const SceneBuilder builder(config.message.capacity(), {devices.names().begin(), devices.names().end()});
  ipc::BuiltScene scene = builder.from_file(options.scene.empty() ? config.message.scene() : options.scene);
  scene.prepared->revision = kFirstRevision;
  scene.description.set_revision(kFirstRevision);

  // devices -> servo thread -> mailbox
  const auto mailbox = std::make_unique<servo::Mailbox>(setup::snapshot_capacity(config.message));
  servo::ServoSettings settings = setup::servo_settings(config.message);
  settings.clock = &setup::stage_clock;
  std::shared_ptr<const engine::Scene> running = scene.prepared->world.shared_scene();
  devices.start();
  servo::ServoLoop loop(settings, devices.devices(), std::move(scene.prepared), *mailbox);
  servo::ServoThread servo_thread(setup::realtime_settings(config.message.servo()), settings.rate_hz, loop);

  // mailbox -> clients, on this thread
  rt::CpuLatency cores;
  ipc::Server server(
      server_settings(options, config.message),
      {.mailbox = *mailbox,
       .version = HAPTIC_VERSION,
       .rate_hz = settings.rate_hz,
       .devices = describe_devices(devices, settings.limits.max_force),
       .real_time = describe_rights(servo_thread.report()),
       .scene = std::move(scene.description),
       .running = std::move(running),
       .build_scene = [&](const v1::LoadScene& request) { return builder.from_request(request); },
       .edit_scene = [&](const v1::EditScene& request,
                         const ipc::RunningScene& edited) { return builder.from_edit(request, edited); },
       .place_device = places_of(devices),
       .armed_changed = [&](bool armed) { keep_awake(cores, armed); }});
  const StopWaiter waiter(signals, [&] {
    spdlog::info("stopping");
    // first what a hand feels, then what a screen shows
    servo_thread.stop();
    server.stop();
  });

  spdlog::info("hapticd {}: {} devices at {} Hz", HAPTIC_VERSION, devices.names().size(), settings.rate_hz);
  log_rights(servo_thread.report());
  for (const std::string& address : server.addresses()) spdlog::info("listening on {}", address);
  server.run();
  spdlog::info("stopped after {} ticks", servo_thread.heartbeat());
}

}  // namespace haptic
