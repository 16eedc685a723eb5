#include <algorithm>
#include <chrono>

#include "ipc/convert.h"
#include "ipc/handlers.h"
#include "ipc/reports.h"

namespace haptic::ipc {
namespace {

// a fault of the whole daemon is latched in each of its devices, and is told once
void add_faults(const Desk& desk, v1::Status& status) {
  for (const servo::DeviceSnapshot& device : desk.publisher.latest().devices) {
    const v1::Fault fault = to_wire(device.fault, desk.services.devices);
    const bool told = std::any_of(status.fault().begin(), status.fault().end(), [&](const v1::Fault& other) {
      return other.kind() == fault.kind() && other.device() == fault.device();
    });
    if (fault.kind() != v1::FAULT_NONE && !told) {
      *status.add_fault() = fault;
    }
  }
}

void add_driver(const Desk& desk, SteadyClock::time_point now, v1::Status& status) {
  if (const auto& holder = desk.lease.holder()) {
    v1::DriveHolder& told = *status.mutable_drive_holder();
    told.set_client(holder->driver.name);
    told.set_program(holder->driver.program);
    told.set_heartbeat_ms(static_cast<std::uint32_t>(holder->silence.count()));
    told.set_silence(std::chrono::duration<double>(now - holder->last_sign).count());
  }
}

}  // namespace

v1::Status report_status(const Desk& desk) {
  v1::Status status;
  const LatestTick& latest = desk.publisher.latest();
  const v1::SceneDescription& scene = desk.scenes.current();
  status.set_version(desk.services.version);
  status.set_tick(latest.tick);
  status.set_rate_hz(desk.services.rate_hz);
  const SteadyClock::time_point now = SteadyClock::now();
  status.set_uptime(std::chrono::duration<double>(now - desk.started).count());
  status.set_armed(latest.armed);
  status.set_paused(latest.paused);
  add_faults(desk, status);
  add_driver(desk, now, status);
  status.set_scene(scene.scene().name());
  status.set_scene_revision(scene.revision());
  status.set_objects(static_cast<std::uint32_t>(scene.object_size()));
  status.set_fingers(static_cast<std::uint32_t>(scene.finger_size()));
  for (const auto& finger : scene.finger()) {
    status.set_hips(status.hips() + finger.hips());
  }
  status.set_devices(static_cast<std::uint32_t>(desk.services.devices.size()));
  status.set_clients(static_cast<std::uint32_t>(desk.count_clients()));
  status.set_missed_ticks(latest.missed_ticks);
  *status.mutable_real_time() = desk.services.real_time;
  return status;
}

void handle_get_status(Desk& desk, const Caller& /*caller*/, const v1::Request& /*request*/,
                       const Reply& reply) {
  v1::Response response;
  *response.mutable_status() = report_status(desk);
  reply.send(std::move(response));
}

}  // namespace haptic::ipc
