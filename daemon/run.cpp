#include "daemon/run.h"

#include <fmt/format.h>
#include <unistd.h>

#include <csignal>
// Boost.Asio of Debian 12 needs it before
#include <spdlog/spdlog.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "daemon/reload.h"
#include "daemon/scene_builder.h"
#include "ipc/server.h"
#include "load/config_file.h"
#include "log/begin_log.h"
#include "rt/cpu_latency.h"
#include "rt/memory_reserve.h"
#include "rt/tick_clock.h"
#include "service/service_manager.h"
#include "service/signals.h"
#include "service/supervisor.h"
#include "servo/servo_loop.h"
#include "servo/servo_thread.h"
#include "setup/device_set.h"
#include "setup/settings.h"

namespace haptic {

namespace {

constexpr std::uint64_t kFirstRevision = 1;
// for letting go in order when memory has run out: answers and frames that wait, a log line
constexpr std::size_t kMemoryReserve = std::size_t{16} * 1024 * 1024;

std::vector<v1::DeviceDescription> describe_devices(const setup::DeviceSet& devices,
                                                    const servo::ServoSettings& settings) {
  std::vector<v1::DeviceDescription> descriptions;
  for (const drivers::Device* const device : devices.devices()) {
    v1::DeviceDescription& told = descriptions.emplace_back();
    told.set_name(device->info().name);
    told.set_driver(device->info().driver);
    const double own = settings.devices[descriptions.size() - 1].limits.max_force;
    told.set_max_force(std::min({device->info().max_force, settings.limits.max_force, own}));
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

std::vector<ipc::DeviceKeeper> keepers_of(const setup::DeviceSet& devices) {
  std::vector<ipc::DeviceKeeper> keepers;
  keepers.reserve(devices.devices().size());
  for (drivers::Device* const device : devices.devices()) {
    keepers.push_back({.state = [device] { return device->state(); },
                       .words = [device] { return device->words(); },
                       .knows = [device](drivers::DeviceAction action) { return device->knows(action); },
                       .request = [device](drivers::DeviceAction action) { device->request(action); }});
  }
  return keepers;
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

}  // namespace

void run(const RunOptions& options) {
  const service::Signals signals;
  const rt::MemoryReserve reserve(kMemoryReserve, []() noexcept { ::kill(::getpid(), SIGTERM); });
  const std::vector<int> passed_sockets = service::take_passed_sockets();

  // what is written in files
  const load::LoadedConfig config = load::load_config(options.config);
  log::begin_log(config.message.log(), options.foreground);
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
  service::Supervisor supervisor(
      settings.rate_hz, fmt::format("{} devices at {} Hz", devices.names().size(), settings.rate_hz));
  ipc::ServerSettings server_settings = settings_of(options, config.message);
  server_settings.passed_sockets = passed_sockets;
  rt::CpuLatency cores;
  ipc::Server server(std::move(server_settings),
                     {.mailbox = *mailbox,
                      .version = HAPTIC_VERSION,
                      .rate_hz = settings.rate_hz,
                      .devices = describe_devices(devices, settings),
                      .real_time = describe_rights(servo_thread.report()),
                      .scene = std::move(scene.description),
                      .running = std::move(running),
                      .build_scene =
                          [&](const v1::LoadScene& request) {
                            const rt::MemoryMayRunOut tolerated;
                            return builder.from_request(request);
                          },
                      .edit_scene =
                          [&](const v1::EditScene& request, const ipc::RunningScene& edited) {
                            const rt::MemoryMayRunOut tolerated;
                            return builder.from_edit(request, edited);
                          },
                      .place_device = places_of(devices),
                      .keepers = keepers_of(devices),
                      .on_poll = [&] { supervisor.look(rt::monotonic_ns(), servo_thread.heartbeat()); },
                      .armed_changed = [&](bool armed) { keep_awake(cores, armed); }});
  Reloader reloader(options, config.message, server);
  const auto reload = [&] { supervisor.reload([&] { reloader.reload(); }); };
  const service::SignalThread waiter(signals, reload, [&] {
    spdlog::info("stopping");
    service::tell_stopping();
    // first what a hand feels, then what a screen shows
    servo_thread.stop();
    server.stop();
  });

  spdlog::info("hapticd {}: {}", HAPTIC_VERSION, supervisor.status());
  log_rights(servo_thread.report());
  for (const std::string& address : server.addresses()) spdlog::info("listening on {}", address);
  server.run();
  if (reserve.is_spent()) throw std::runtime_error("memory has run out; forces were let down first");
  spdlog::info("stopped after {} ticks", servo_thread.heartbeat());
}

}  // namespace haptic
