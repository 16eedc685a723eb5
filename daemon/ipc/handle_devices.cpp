#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

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
  set(*out.mutable_acceleration(), device.acceleration);
  for (int kind = v1::LIMIT_NONE + 1; kind <= v1::LimitKind_MAX; ++kind) {
    if ((device.limits & (1U << static_cast<unsigned>(kind))) != 0) {
      out.add_limit(static_cast<v1::LimitKind>(kind));
    }
  }
  out.set_mean_force(device.mean_force);
  out.set_energy(device.energy);
  out.set_clutched(device.clutched);
  if (device.fault.kind != safety::FaultKind::kNone) {
    *out.mutable_fault() = to_wire(device.fault, services.devices);
  }
  out.set_phase(phase_of(device));
}

void describe_life(const DeviceKeeper& keeper, v1::DeviceStatus& out) {
  const drivers::DeviceWords words = keeper.words();
  out.set_reason(words.reason);
  out.set_serial(words.serial);
  out.set_losses(keeper.state().losses);
}

std::string silent(const v1::DeviceStatus& device) {
  if (device.description().driver() == "virtual") {
    return "no client tells where it is";
  }
  return "no sample comes from it";
}

std::string_view name_of(v1::ManageDevice::Action action) noexcept {
  switch (action) {
    case v1::ManageDevice::IDENTIFY:
      return "identify";
    case v1::ManageDevice::HOME:
      return "home";
    case v1::ManageDevice::CALIBRATE:
      return "calibrate";
    default:
      return "reopen";
  }
}

std::optional<drivers::DeviceAction> to_action(v1::ManageDevice::Action action) noexcept {
  switch (action) {
    case v1::ManageDevice::IDENTIFY:
      return drivers::DeviceAction::kIdentify;
    case v1::ManageDevice::HOME:
      return drivers::DeviceAction::kHome;
    case v1::ManageDevice::CALIBRATE:
      return drivers::DeviceAction::kCalibrate;
    case v1::ManageDevice::REOPEN:
      return drivers::DeviceAction::kReopen;
    default:
      return std::nullopt;
  }
}

v1::Error wrong(v1::Error::Code code, const std::string& field, const std::string& message) {
  v1::Error error = make_error(code, message);
  error.set_field("manage_device." + field);
  return error;
}

bool is_open(drivers::DevicePhase phase) noexcept { return phase >= drivers::DevicePhase::kOpening; }

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
    if (i < desk.services.keepers.size()) {
      describe_life(desk.services.keepers[i], device);
    }
    if (device.phase() == v1::DEVICE_ABSENT && device.reason().empty()) {
      device.set_reason(silent(device));
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

void handle_manage_device(Desk& desk, const Caller& caller, const v1::Request& request, const Reply& reply) {
  const v1::ManageDevice& manage = request.manage_device();
  const std::string& name = manage.device();
  const std::vector<v1::DeviceDescription>& devices = desk.services.devices;
  const auto found =
      std::find_if(devices.begin(), devices.end(), [&](const auto& one) { return one.name() == name; });
  if (found == devices.end()) {
    return reply.fail(wrong(v1::Error::NOT_FOUND, "device", "there is no device \"" + name + "\""));
  }
  const std::optional<drivers::DeviceAction> action = to_action(manage.action());
  if (!action) {
    return reply.fail(wrong(v1::Error::INVALID, "action", "is none of IDENTIFY, HOME, CALIBRATE, REOPEN"));
  }
  if (const auto refusal = desk.lease.refusal(caller.id)) {
    return reply.fail(v1::Error::REFUSED, *refusal + "; only its holder can manage devices");
  }
  const auto index = static_cast<std::size_t>(found - devices.begin());
  const LatestTick& latest = desk.publisher.latest();
  if (index < latest.devices.size() && latest.devices[index].armed) {
    return reply.fail(v1::Error::REFUSED, "\"" + name + "\" is armed; disarm it first");
  }
  const DeviceKeeper* const keeper =
      index < desk.services.keepers.size() ? &desk.services.keepers[index] : nullptr;
  if (keeper == nullptr || !keeper->knows(*action)) {
    return reply.fail(v1::Error::UNSUPPORTED, "the driver " + found->driver() + " of \"" + name +
                                                  "\" does not know how to " +
                                                  std::string(name_of(manage.action())));
  }
  if (*action != drivers::DeviceAction::kReopen && !is_open(keeper->state().phase)) {
    return reply.fail(v1::Error::FAILED, "\"" + name + "\" is not open: " + keeper->words().reason);
  }
  keeper->request(*action);
  reply.done();
}

}  // namespace haptic::ipc
