#include "simulate/tick_csv.h"

namespace haptic::simulate {

namespace {

constexpr std::string_view kHipColumns =
    "tick,time,finger,hip,object,state,slipping,hip_x,hip_y,hip_z,proxy_x,proxy_y,proxy_z,force_x,force_y,"
    "force_z";
constexpr std::string_view kObjectColumns =
    "tick,time,object,x,y,z,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz,fx,fy,fz,tx,ty,tz";
constexpr std::string_view kDeviceColumns =
    "tick,time,device,x,y,z,qw,qx,qy,qz,fx,fy,fz,tx,ty,tz,armed,fault";

}  // namespace

TickCsv::TickCsv(const CsvPaths& paths) {
  if (!paths.hips.empty()) hips_.emplace(paths.hips, kHipColumns);
  if (!paths.objects.empty()) objects_.emplace(paths.objects, kObjectColumns);
  if (!paths.devices.empty()) devices_.emplace(paths.devices, kDeviceColumns);
}

void TickCsv::write(double time, const engine::World& world, const servo::Snapshot& snapshot,
                    std::span<const std::string> devices) {
  if (hips_) write_hips(time, world, snapshot.tick);
  if (objects_) write_objects(time, world.scene(), snapshot);
  if (devices_) write_devices(time, snapshot, devices);
}

void TickCsv::close() {
  if (hips_) hips_->close();
  if (objects_) objects_->close();
  if (devices_) devices_->close();
}

void TickCsv::write_hips(double time, const engine::World& world, std::uint64_t tick) {
  const engine::Scene& scene = world.scene();
  const engine::State& state = world.state();
  for (const engine::Finger& finger : scene.fingers) {
    for (std::size_t i = 0; i < finger.hips.size(); ++i) {
      const std::size_t hip = finger.first_hip + i;
      const glm::dvec3& position = state.hip_positions[hip];
      const auto row = [&](std::string_view object, const engine::Proxy& proxy, const glm::dvec3& where,
                           const glm::dvec3& force) {
        hips_->add(tick).add(time).add(finger.name).add(std::uint64_t{i}).add(object);
        hips_->add(engine::name_of(proxy.state)).add(proxy.slipping).add(position).add(where).add(force);
        hips_->end_row();
      };
      bool held = false;
      for (std::size_t object = 0; object < scene.objects.size(); ++object) {
        const std::size_t contact = object * scene.hip_count + hip;
        const engine::Proxy& proxy = state.proxies[contact];
        if (proxy.state == engine::ConstraintState::kOut) continue;
        held = true;
        row(scene.objects[object].name, proxy, world.proxy_in_world(object, hip),
            state.contact_forces[contact]);
      }
      if (!held) row("", engine::Proxy{}, position, glm::dvec3(0.0));
    }
  }
}

void TickCsv::write_objects(double time, const engine::Scene& scene, const servo::Snapshot& snapshot) {
  for (std::size_t i = 0; i < snapshot.objects.size(); ++i) {
    const servo::ObjectSnapshot& object = snapshot.objects[i];
    objects_->add(snapshot.tick).add(time).add(scene.objects[i].name);
    objects_->add(object.position).add(object.orientation).add(object.velocity).add(object.angular_velocity);
    objects_->add(object.force).add(object.torque);
    objects_->end_row();
  }
}

void TickCsv::write_devices(double time, const servo::Snapshot& snapshot,
                            std::span<const std::string> devices) {
  for (std::size_t i = 0; i < snapshot.devices.size(); ++i) {
    const servo::DeviceSnapshot& device = snapshot.devices[i];
    const bool faulty = device.fault.kind != safety::FaultKind::kNone;
    devices_->add(snapshot.tick).add(time).add(devices[i]);
    devices_->add(device.position).add(device.orientation).add(device.force).add(device.torque);
    devices_->add(snapshot.armed).add(faulty ? safety::name_of(device.fault.kind) : "");
    devices_->end_row();
  }
}

}  // namespace haptic::simulate
