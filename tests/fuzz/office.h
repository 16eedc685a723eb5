#pragma once
// All that requests are dispatched to, with nobody behind it but a servo thread's end that does what it is
// told.

#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <vector>

#include "ipc/dispatch.h"

namespace haptic::fuzz {

class Office {
 public:
  ipc::Desk& desk() noexcept { return desk_; }

  /// Obeys what waits for the servo thread; returns how many commands there were that change something.
  std::size_t obey() {
    std::size_t commands = 0;
    servo::Command command;
    while (mailbox_.commands.pop(command)) {
      commands += command.kind != servo::CommandKind::kCopyState ? 1 : 0;
      mailbox_.events.push({.command = command.kind, .request = command.request, .copy = command.copy});
    }
    servo_.poll({});
    return commands;
  }

 private:
  static std::vector<v1::DeviceDescription> devices() {
    std::vector<v1::DeviceDescription> devices(1);
    devices[0].set_name("mouse");
    devices[0].set_driver("virtual");
    return devices;
  }

  // what a handler lets through is finite, and a rotation
  static ipc::LiveForce place(const ipc::DevicePlace& place) {
    const double sum = place.position.x + place.position.y + place.position.z;
    const double length = glm::length(place.orientation);
    if (!std::isfinite(sum) || !(std::abs(length - 1.0) < 1e-9)) {
      std::abort();
    }
    return {};
  }

  template <class... Request>
  static ipc::BuiltScene refuse(const Request&... /*request*/) {
    throw ipc::SceneError(ipc::make_error(v1::Error::FAILED, "no scene is built here"));
  }

  servo::Mailbox mailbox_{servo::Capacity{1, 1, 1, 1, 1}};
  ipc::Services services_{.mailbox = mailbox_,
                          .version = "1",
                          .rate_hz = 1000.0,
                          .devices = devices(),
                          .real_time = {},
                          .scene = {},
                          .running = std::make_shared<const engine::Scene>(),
                          .build_scene = refuse<v1::LoadScene>,
                          .edit_scene = refuse<v1::EditScene, ipc::RunningScene>,
                          .place_device = {place}};
  ipc::ServoLink servo_{mailbox_, std::chrono::seconds(1), [](const servo::Event&) {}};
  ipc::SceneStore scenes_{services_, servo_};
  ipc::Publisher publisher_;
  ipc::DriveLease lease_{ipc::DrivePolicy(), servo_};
  ipc::Desk desk_{services_, servo_, scenes_, publisher_, {}, [] { return std::size_t{1}; }, lease_};
};

}  // namespace haptic::fuzz
