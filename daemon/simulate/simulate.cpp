#include "simulate/simulate.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <ostream>
#include <vector>

#include "load/config_file.h"
#include "load/scene_file.h"
#include "rt/tick_clock.h"
#include "servo/prepare_scene.h"
#include "servo/servo_loop.h"
#include "setup/device_set.h"
#include "setup/settings.h"
#include "simulate/tick_recording.h"

namespace haptic::simulate {

namespace {

using SteadyClock = std::chrono::steady_clock;

std::shared_ptr<const load::LoadedScene> scene_of(const SimulateOptions& options,
                                                  const v1::DaemonConfig& config) {
  const std::string& file = options.scene.empty() ? config.scene() : options.scene;
  if (file.empty()) return std::make_shared<const load::LoadedScene>();
  return load::load_scene(file, config.capacity());
}

// HIPs in snapshots cost time that only a recording is worth
servo::Capacity capacity_for(const engine::Scene& scene, std::size_t devices, bool records) {
  return {.objects = scene.objects.size(),
          .fingers = 0,
          .hips = records ? scene.hip_count : 0,
          .contacts = records ? scene.hip_count * scene.objects.size() : 0,
          .devices = devices};
}

void tell_faults(servo::Mailbox& mailbox, double rate_hz, std::span<const std::string> devices,
                 TickRecording* recording, std::uint64_t time_ns, std::ostream& summary) {
  mailbox.events.consume_all([&](const servo::Event& event) {
    if (event.kind != servo::EventKind::kFaultLatched) return;
    const safety::Fault& fault = event.fault;
    const std::string device = fault.device < devices.size() ? " of " + devices[fault.device] : "";
    summary << fmt::format("fault at {} s: {}{}: {:.6g}, allowed {:.6g}; forces are zero from then on\n",
                           static_cast<double>(fault.tick) / rate_hz, safety::name_of(fault.kind), device,
                           fault.value, fault.limit);
    if (recording != nullptr) recording->write(fault, time_ns);
  });
}

void tell_transitions(const engine::TransitionTable& table, std::ostream& summary) {
  summary << "transitions             count   mean ns\n";
  for (std::size_t before = 0; before < table.count.size(); ++before) {
    for (std::size_t after = 0; after < table.count.size(); ++after) {
      if (table.count[before][after] == 0) continue;
      const auto timed = static_cast<double>(table.timed[before][after]);
      const auto mean =
          timed > 0.0 ? fmt::format("{:.0f}", static_cast<double>(table.nanoseconds[before][after]) / timed)
                      : std::string("-");
      summary << fmt::format(
          "  {} -> {} {:>16} {:>9}\n", engine::name_of(static_cast<engine::ConstraintState>(before)),
          engine::name_of(static_cast<engine::ConstraintState>(after)), table.count[before][after], mean);
    }
  }
  summary << fmt::format("  ended by the bound on transitions {}, circles broken {}\n", table.limited,
                         table.relocations);
}

}  // namespace

void simulate(const SimulateOptions& options, std::ostream& summary) {
  const load::LoadedConfig config = load::load_config(options.config);
  const std::shared_ptr<const load::LoadedScene> loaded = scene_of(options, config.message);
  const std::shared_ptr<const engine::Scene> scene(loaded, &loaded->scene);
  setup::require_computed_devices(config);
  setup::DeviceSet devices(config);
  TickCsv csv(options.csv);

  const auto mailbox = std::make_unique<servo::Mailbox>(
      capacity_for(*scene, devices.names().size(), !options.recording.empty()));
  servo::ServoSettings settings = setup::servo_settings(config.message);
  settings.armed_from_start = true;
  if (options.verbose) settings.clock = &setup::stage_clock;
  std::optional<TickRecording> recording;
  if (!options.recording.empty()) {
    recording.emplace(options.recording, *loaded, settings.rate_hz, devices.names());
  }
  devices.start();
  servo::ServoLoop loop(settings, devices.devices(), servo::prepare_scene(scene, 1, devices.names()),
                        *mailbox);

  const SteadyClock::time_point started = SteadyClock::now();
  const rt::TickSchedule schedule(0, settings.rate_hz);
  const auto time_of = [&](std::uint64_t tick) { return static_cast<double>(tick) / settings.rate_hz; };
  std::uint64_t tick = 0;
  for (; time_of(tick) <= options.duration; ++tick) {
    loop.tick({.tick = tick, .time = schedule.due_ns(tick)});
    const servo::Snapshot& snapshot = *mailbox->snapshots.take();
    csv.write(time_of(tick), loop.scene().world, snapshot, devices.names());
    if (recording) recording->write(snapshot);
    if (recording && tick == 0) recording->write(loop.scene().world.state(), snapshot);
    tell_faults(*mailbox, settings.rate_hz, devices.names(), recording ? &*recording : nullptr,
                static_cast<std::uint64_t>(schedule.due_ns(tick)), summary);
  }
  csv.close();
  if (recording) recording->close();

  const double took = std::chrono::duration<double>(SteadyClock::now() - started).count();
  const double simulated = time_of(tick);
  summary << fmt::format("{} ticks, {:.6g} s in {:.3g} s: {:.3g} times real time\n", tick, simulated, took,
                         simulated / took);
  if (options.verbose) tell_transitions(loop.scene().world.transitions(), summary);
}

}  // namespace haptic::simulate
