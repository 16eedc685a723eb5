#pragma once
// A servo loop on a virtual clock, with devices that a test moves by hand and a scene that is one rigid wall:
// solid below z = 0, air above.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "drivers/device.h"
#include "engine/scene.h"
#include "servo/prepare_scene.h"
#include "servo/servo_loop.h"
#include "tests/support/meshes.h"

namespace haptic::test {

/// A device that is where the test puts it, and remembers what it was told.
class HandDevice final : public drivers::Device {
 public:
  explicit HandDevice(const std::string& name) : info_{.name = name, .driver = "hand", .max_force = 1e9} {}

  const drivers::DeviceInfo& info() const noexcept override { return info_; }
  void start() override {}
  void stop() noexcept override {}
  drivers::DeviceState state() const noexcept override { return life; }
  bool read(drivers::Nanoseconds now, drivers::DeviceSample& out) noexcept override {
    if (!connected) return false;
    if (fresh) sample.time = now;
    out = sample;
    return true;
  }
  void write(drivers::Nanoseconds now, const drivers::ForceCommand& command) noexcept override {
    written_at = now;
    written = command;
  }

  bool connected = true;
  bool fresh = true;  // each read() measures anew
  drivers::DeviceState life;
  drivers::DeviceSample sample;
  drivers::Nanoseconds written_at = -1;
  drivers::ForceCommand written;

 private:
  drivers::DeviceInfo info_;
};

inline constexpr double kWallStiffness = 100.0;  // N/m of the finger

/// One point finger on each device named, before the wall. It feels k * depth along z.
inline std::shared_ptr<engine::Scene> wall_scene(const std::vector<std::string>& devices) {
  auto scene = std::make_shared<engine::Scene>();
  scene->name = "wall";
  engine::Object wall;
  wall.name = "wall";
  const engine::TetraMesh mesh = kuhn_grid({2, 2, 2}, glm::dvec3{-0.1}, glm::dvec3{0.1},
                                           [](const glm::dvec3& p) { return p.z < 0.0 ? 1 : 0; });
  wall.cells = std::make_shared<const engine::CellComplex>(engine::CellComplex::build(mesh));
  engine::Material solid;
  solid.yield_force = engine::kRigid;
  wall.materials = {engine::Material{}, solid};
  scene->objects.push_back(wall);
  for (const std::string& device : devices) {
    engine::Finger finger;
    finger.name = "on " + device;
    finger.device = device;
    finger.stiffness = kWallStiffness;
    finger.hips = engine::point_layout();
    scene->fingers.push_back(finger);
  }
  engine::number_hips(*scene);
  return scene;
}

/// Limits of which none acts within the tests' forces and speeds.
inline safety::GuardLimits wide_limits() {
  return {.max_force = 1e3,
          .max_force_rate = 1e9,
          .max_speed = 2.0,
          .arm_ramp = 0.0,
          .max_sample_age = 0.02,
          .max_energy = 1e9,
          .max_arm_force = 1e9};
}

class ServoRig {
 public:
  explicit ServoRig(const servo::ServoSettings& settings, const std::vector<std::string>& names = {"a", "b"})
      : names_(names), rate_hz_(settings.rate_hz) {
    for (const std::string& name : names) devices_.push_back(std::make_unique<HandDevice>(name));
    std::vector<drivers::Device*> pointers;
    for (const auto& device : devices_) pointers.push_back(device.get());
    loop_ = std::make_unique<servo::ServoLoop>(settings, pointers, prepare(1), *mailbox_);
  }

  HandDevice& device(std::size_t i) { return *devices_[i]; }
  servo::ServoLoop& loop() { return *loop_; }
  servo::Mailbox& mailbox() { return *mailbox_; }

  std::unique_ptr<servo::PreparedScene> prepare(std::uint64_t revision) {
    return servo::prepare_scene(wall_scene(names_), revision, names_);
  }

  void tick(int count = 1, std::uint64_t missed = 0) noexcept {
    for (int i = 0; i < count; ++i) {
      next_ += missed;
      const double time = static_cast<double>(next_) * 1e9 / rate_hz_;
      loop_->tick({.tick = next_, .time = static_cast<drivers::Nanoseconds>(time), .missed = missed});
      ++next_;
    }
  }

  /// Sends the command; the next tick takes it.
  void send(servo::CommandKind kind, std::uint64_t request = 1, std::uint64_t ticks = 0) {
    mailbox_->commands.push({.kind = kind, .request = request, .ticks = ticks});
  }

  /// All events that have come since the last call.
  std::vector<servo::Event> events() {
    std::vector<servo::Event> all;
    mailbox_->events.consume_all([&](const servo::Event& event) { all.push_back(event); });
    return all;
  }

  /// The newest snapshot.
  const servo::Snapshot& snapshot() {
    while (const servo::Snapshot* newer = mailbox_->snapshots.take()) latest_ = *newer;
    return latest_;
  }

 private:
  std::vector<std::string> names_;
  double rate_hz_;
  std::unique_ptr<servo::Mailbox> mailbox_ = std::make_unique<servo::Mailbox>(
      servo::Capacity{.objects = 4, .fingers = 4, .hips = 8, .contacts = 8, .devices = 4});
  std::vector<std::unique_ptr<HandDevice>> devices_;
  std::unique_ptr<servo::ServoLoop> loop_;
  std::uint64_t next_ = 0;
  servo::Snapshot latest_;
};

}  // namespace haptic::test
