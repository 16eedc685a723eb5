#include <algorithm>
#include <chrono>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <string>
#include <utility>

#include "ipc/convert.h"
#include "ipc/handlers.h"

namespace haptic::ipc {
namespace {

constexpr double kFarthest = 1e6;   // m; as in files: far beyond any room, far from overflow
constexpr double kFastest = 1e6;    // m/s; the guard has the say long before
constexpr double kShortest = 1e-6;  // of a quaternion that can be normalised

v1::Error wrong(const std::string& field, const std::string& message) {
  v1::Error error = make_error(v1::Error::INVALID, message);
  error.set_field("move_device." + field);
  return error;
}

std::optional<v1::Error> check_vector(const std::string& field, const v1::Vector3& v, double largest) {
  using Component = std::pair<const char*, double>;
  for (const auto& [axis, value] :
       std::initializer_list<Component>{{".x", v.x()}, {".y", v.y()}, {".z", v.z()}}) {
    if (!std::isfinite(value)) {
      return wrong(field + axis, "is no finite number");
    }
    if (std::abs(value) > largest) {
      return wrong(field + axis, std::to_string(value) + " is out of range (permitted: " +
                                     std::to_string(-largest) + " to " + std::to_string(largest) + ")");
    }
  }
  return std::nullopt;
}

// all zero is the identity
glm::dquat rotation(const v1::Quaternion& q) {
  const glm::dquat turn(q.w(), q.x(), q.y(), q.z());
  return turn == glm::dquat(0.0, 0.0, 0.0, 0.0) ? glm::dquat(1.0, 0.0, 0.0, 0.0) : glm::normalize(turn);
}

std::optional<v1::Error> check_rotation(const v1::Quaternion& q) {
  const double length = std::hypot(std::hypot(q.w(), q.x()), std::hypot(q.y(), q.z()));
  if (!std::isfinite(length) || length > kFarthest) {
    return wrong("pose.orientation", "is no finite rotation");
  }
  const bool is_identity = q.w() == 0.0 && q.x() == 0.0 && q.y() == 0.0 && q.z() == 0.0;
  if (!is_identity && length < kShortest) {
    return wrong("pose.orientation", "is too short to be a rotation");
  }
  return std::nullopt;
}

std::optional<v1::Error> check(const v1::MoveDevice& move, std::int64_t now_ns) {
  auto error = check_vector("pose.position", move.pose().position(), kFarthest);
  if (!error) {
    error = check_rotation(move.pose().orientation());
  }
  if (!error) {
    error = check_vector("velocity", move.velocity(), kFastest);
  }
  // a sample from the future would never grow old
  if (!error && move.monotonic_ns() > static_cast<std::uint64_t>(now_ns)) {
    error =
        wrong("monotonic_ns", "is in future; it is CLOCK_MONOTONIC of the daemon's machine, or is left away");
  }
  return error;
}

std::optional<std::uint32_t> find_device(const Services& services, const std::string& name) {
  for (std::size_t i = 0; i < services.devices.size(); ++i) {
    if (services.devices[i].name() == name) {
      return static_cast<std::uint32_t>(i);
    }
  }
  return std::nullopt;
}

bool can_be_moved(const Services& services, std::uint32_t device) {
  return device < services.place_device.size() && services.place_device[device];
}

glm::dvec3 vector(const v1::Vector3& v) { return {v.x(), v.y(), v.z()}; }

void set(v1::Vector3& out, const glm::dvec3& v) {
  out.set_x(v.x);
  out.set_y(v.y);
  out.set_z(v.z);
}

void send_force(const LiveForce& live, std::int64_t now_ns, const Reply& reply) {
  v1::Response response;
  v1::DeviceForce& force = *response.mutable_device_force();
  set(*force.mutable_wrench()->mutable_force(), live.force);
  set(*force.mutable_wrench()->mutable_torque(), live.torque);
  force.set_expires_ns(static_cast<std::uint64_t>(live.expires_ns));
  force.set_lifetime(static_cast<double>(std::max<std::int64_t>(0, live.expires_ns - now_ns)) * 1e-9);
  reply.send(std::move(response));
}

}  // namespace

void handle_move_device(Desk& desk, const Caller& caller, const v1::Request& request, const Reply& reply) {
  const v1::MoveDevice& move = request.move_device();
  const SteadyClock::time_point now = SteadyClock::now();
  const std::int64_t now_ns =
      std::chrono::duration_cast<std::chrono::nanoseconds>(now.time_since_epoch()).count();

  const std::optional<std::uint32_t> device = find_device(desk.services, move.device());
  if (!device) {
    v1::Error error = make_error(v1::Error::NOT_FOUND, "there is no device \"" + move.device() + "\"");
    error.set_field("move_device.device");
    return reply.fail(error);
  }
  if (!can_be_moved(desk.services, *device)) {
    return reply.fail(wrong("device", "\"" + move.device() + "\" is moved by the driver " +
                                          desk.services.devices[*device].driver() +
                                          "; only a virtual device can be moved by a client"));
  }
  if (const auto refusal = desk.lease.refusal(caller.id)) {
    return reply.fail(v1::Error::REFUSED, *refusal + "; only its holder can move devices");
  }
  if (const auto error = check(move, now_ns)) {
    return reply.fail(*error);
  }
  // whoever holds the lease need not wait until another has fallen silent
  const auto refusal = desk.moves.refusal(*device, caller.id, now);
  if (refusal && !desk.lease.holder()) {
    return reply.fail(v1::Error::REFUSED, *refusal);
  }
  const std::int64_t time_ns =
      move.monotonic_ns() == 0 ? now_ns : static_cast<std::int64_t>(move.monotonic_ns());
  if (desk.moves.is_old(*device, caller.id, move.sequence(), time_ns)) {
    return reply.fail(v1::Error::NOTHING_TO_DO, "a newer sample of this device has come before");
  }

  desk.moves.take(*device, {caller.id, caller.name, move.sequence(), time_ns, now});
  DevicePlace place{.time_ns = time_ns,
                    .position = vector(move.pose().position()),
                    .orientation = rotation(move.pose().orientation()),
                    .buttons = move.buttons()};
  if (move.has_velocity()) {
    place.velocity = vector(move.velocity());
  }
  send_force(desk.services.place_device[*device](place), now_ns, reply);
}

}  // namespace haptic::ipc
