#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <memory>

#include "client/cli/changes.h"
#include "client/cli/screen.h"
#include "client/cli/verbs.h"
#include "client/lib/error.h"

namespace haptic::cli {
namespace {

using std::chrono::milliseconds;

constexpr double kLongestMove = 86400.0;  // s
constexpr milliseconds kPosePeriod{5};    // of the poses; a quarter of the default of safety.max_sample_age

struct MoveOptions {
  std::string name;
  v1::Pose pose;
  double over = 0.0;  // s
  double hold = 0.0;  // s
  std::uint32_t buttons = 0;
};

v1::DeviceStatus ask_device(client::Connection& daemon, const std::string& name) {
  const v1::Response response = call(daemon, [](v1::Request& request) { request.mutable_list_devices(); });
  for (const v1::DeviceStatus& device : response.devices().device()) {
    if (device.description().name() == name) {
      return device;
    }
  }
  v1::Error error;
  error.set_code(v1::Error::NOT_FOUND);
  error.set_message("there is no device \"" + name + "\"");
  throw client::NotFound(error);
}

v1::Vector3 between(const v1::Vector3& a, const v1::Vector3& b, double part) {
  v1::Vector3 v;
  v.set_x(a.x() + part * (b.x() - a.x()));
  v.set_y(a.y() + part * (b.y() - a.y()));
  v.set_z(a.z() + part * (b.z() - a.z()));
  return v;
}

// the shorter way; the daemon normalises it
v1::Quaternion between(const v1::Quaternion& a, const v1::Quaternion& b, double part) {
  const double cosine = a.w() * b.w() + a.x() * b.x() + a.y() * b.y() + a.z() * b.z();
  const double of_b = cosine < 0.0 ? -part : part;
  v1::Quaternion q;
  q.set_w((1.0 - part) * a.w() + of_b * b.w());
  q.set_x((1.0 - part) * a.x() + of_b * b.x());
  q.set_y((1.0 - part) * a.y() + of_b * b.y());
  q.set_z((1.0 - part) * a.z() + of_b * b.z());
  return q;
}

/// Where it begins and ends; a device that is nowhere begins where it ends.
struct Way {
  v1::Pose from;
  v1::Pose to;
};

Way way_of(const v1::DeviceStatus& device, const MoveOptions& options) {
  Way way;
  way.to = options.pose;
  if (device.present() && !way.to.has_orientation()) {
    *way.to.mutable_orientation() = device.pose().orientation();
  }
  if (!way.to.has_orientation()) {
    way.to.mutable_orientation()->set_w(1.0);
  }
  way.from = device.present() ? device.pose() : way.to;
  return way;
}

v1::DeviceForce send_pose(client::Connection& daemon, const MoveOptions& options, const Way& way,
                          double part) {
  const v1::Response response = call(daemon, [&](v1::Request& request) {
    v1::MoveDevice& move = *request.mutable_move_device();
    move.set_device(options.name);
    *move.mutable_pose()->mutable_position() = between(way.from.position(), way.to.position(), part);
    *move.mutable_pose()->mutable_orientation() = between(way.from.orientation(), way.to.orientation(), part);
    move.set_buttons(options.buttons);
  });
  return response.device_force();
}

ExitCode move(Command& command, const MoveOptions& options) {
  using Seconds = std::chrono::duration<double>;
  catch_stop_signals();
  client::Connection& daemon = command.connect();
  const Way way = way_of(ask_device(daemon, options.name), options);
  const client::Clock::time_point start = client::Clock::now();
  client::Clock::time_point next = start;
  v1::DeviceForce force;
  double passed = 0.0;
  do {
    passed = Seconds(client::Clock::now() - start).count();
    force = send_pose(daemon, options, way, options.over > 0.0 ? std::min(1.0, passed / options.over) : 1.0);
    next += kPosePeriod;
    // events are taken meanwhile, so that they do not heap up
    while (!stop_requested() && client::Clock::now() < next) {
      daemon.receive(std::chrono::ceil<milliseconds>(next - client::Clock::now()));
    }
  } while (!stop_requested() && passed < options.over + options.hold);
  if (stop_requested()) {
    return kFailed;
  }
  if (command.json) {
    print_json(force);
  } else {
    const v1::Vector3& f = force.wrench().force();
    fmt::print("{} was moved; it pushes by {:.3f} {:.3f} {:.3f} N\n", options.name, f.x(), f.y(), f.z());
  }
  return kDone;
}

}  // namespace

void add_device(CLI::App& app, Command& command) {
  CLI::App& device = add_family(app, command, "device", "move a virtual device");
  const auto options = std::make_shared<MoveOptions>();
  CLI::App& verb = add_verb(device, command, "move", "tell where a virtual device is, for a while",
                            [options](Command& chosen) { return move(chosen, *options); });
  add_option(verb, "name", options->name, "which").required().type("DEVICE");
  add_pose_options(verb, [options](const PoseChange& change) { change(options->pose); });
  find_option(verb, "--at").required();
  add_option(verb, "--over", options->over, "straight from where it is, within so long; default: at once")
      .between(0.0, kLongestMove)
      .type("SECONDS");
  add_option(verb, "--hold", options->hold, "stay there for so long")
      .between(0.0, kLongestMove)
      .type("SECONDS");
  add_option(verb, "--buttons", options->buttons, "those that are down: bit n for button n").type("N");
  set_footer(
      device,
      "hapticctl device move mouse --at 0 0.02 0 --over 1 --hold 5\n"
      "The pose is told 200 times a second. Afterwards nobody tells it any more: the device counts as lost, "
      "and\n"
      "if force is allowed then a fault is latched.");
}

}  // namespace haptic::cli
