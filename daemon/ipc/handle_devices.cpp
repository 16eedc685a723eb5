#include "ipc/convert.h"
#include "ipc/handlers.h"
#include "ipc/reports.h"

namespace haptic::ipc {
namespace {

void set(v1::Vector3& out, const glm::dvec3& v) {
  out.set_x(v.x);
  out.set_y(v.y);
  out.set_z(v.z);
}

void set(v1::Quaternion& out, const glm::dquat& q) {
  out.set_w(q.w);
  out.set_x(q.x);
  out.set_y(q.y);
  out.set_z(q.z);
}

void describe(const servo::DeviceSnapshot& device, const Services& services, v1::DeviceStatus& out) {
  out.set_present(device.present);
  set(*out.mutable_pose()->mutable_position(), device.position);
  set(*out.mutable_pose()->mutable_orientation(), device.orientation);
  set(*out.mutable_velocity(), device.velocity);
  out.set_buttons(device.buttons);
  set(*out.mutable_wrench()->mutable_force(), device.force);
  set(*out.mutable_wrench()->mutable_torque(), device.torque);
  out.set_sample_age(device.sample_age);
  if (device.fault.kind != safety::FaultKind::kNone) {
    *out.mutable_fault() = to_wire(device.fault, services.devices);
  }
}

}  // namespace

v1::DeviceList report_devices(const Desk& desk) {
  const LatestTick& latest = desk.publisher.latest();
  v1::DeviceList list;
  for (std::size_t i = 0; i < desk.services.devices.size(); ++i) {
    v1::DeviceStatus& device = *list.add_device();
    *device.mutable_description() = desk.services.devices[i];
    device.mutable_description()->clear_finger();
    for (const auto& finger : desk.scenes.current().finger()) {
      if (finger.device() == device.description().name()) {
        device.mutable_description()->add_finger(finger.name());
      }
    }
    if (i < latest.devices.size()) {
      describe(latest.devices[i], desk.services, device);
    }
  }
  return list;
}

void handle_list_devices(Desk& desk, const Caller& /*caller*/, const v1::Request& /*request*/,
                         const Reply& reply) {
  v1::Response response;
  *response.mutable_devices() = report_devices(desk);
  reply.send(std::move(response));
}

}  // namespace haptic::ipc
