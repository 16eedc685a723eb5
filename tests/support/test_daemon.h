#pragma once
// A daemon in this process: the real server on a socket in a directory of its own, with a fake servo behind
// it. Its scene has one object, "block", and one finger of two HIPs, "thumb", on the device "left".

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "ipc/server.h"
#include "tests/support/fake_servo.h"
#include "tests/support/temporary_folder.h"

namespace haptic::test {

inline v1::SceneDescription example_scene() {
  v1::SceneDescription scene;
  scene.set_revision(1);
  scene.mutable_scene()->set_name("example");
  scene.mutable_scene()->add_object()->set_name("block");
  v1::Finger& finger = *scene.mutable_scene()->add_finger();
  finger.set_name("thumb");
  finger.set_device("left");
  finger.set_stiffness(500.0);
  auto& object = *scene.add_object();
  object.set_name("block");
  object.set_cells(6);
  object.set_vertices(8);
  auto& described = *scene.add_finger();
  described.set_name("thumb");
  described.set_device("left");
  described.set_hips(2);
  return scene;
}

/// Builds a scene without anything in it; a path gives an error with a place, as a file would.
inline ipc::BuiltScene build_example(const v1::LoadScene& request) {
  if (request.has_path()) {
    v1::Error error;
    error.set_code(v1::Error::INVALID);
    error.set_message("0 is out of range");
    error.set_field("object[0].shape.box.size.x");
    error.set_file(request.path());
    error.set_line(7);
    error.set_column(3);
    throw ipc::SceneError(error);
  }
  ipc::BuiltScene built;
  built.prepared = std::make_unique<servo::PreparedScene>(
      servo::PreparedScene{.revision = 0,
                           .world = engine::World(std::make_shared<const engine::Scene>()),
                           .device_of_finger = {},
                           .finger_poses = {}});
  *built.description.mutable_scene() = request.scene();
  return built;
}

/// Takes the gravity that a client sets, and refuses anything else.
inline ipc::BuiltScene edit_example(const v1::EditScene& request, const ipc::RunningScene& running) {
  v1::LoadScene load;
  *load.mutable_scene() = running.message;
  for (const v1::SceneEdit& edit : request.edit()) {
    if (!edit.has_set_gravity()) {
      v1::Error error;
      error.set_code(v1::Error::INVALID);
      error.set_field("edit[0]");
      throw ipc::SceneError(error);
    }
    *load.mutable_scene()->mutable_gravity() = edit.set_gravity();
  }
  ipc::BuiltScene built = build_example(load);
  built.prepared->carry = servo::Carry{.from_revision = running.revision, .map = {}};
  return built;
}

class TestDaemon {
 public:
  /// `on_poll` is called on the io thread, now and then.
  explicit TestDaemon(ipc::ServerSettings settings = {}, std::function<void()> on_poll = {})
      : mailbox_(std::make_unique<servo::Mailbox>(
            servo::Capacity{.objects = 8, .fingers = 2, .hips = 4096, .contacts = 64, .devices = 2})),
        servo_(*mailbox_) {
    if (settings.listen.empty()) {
      settings.listen.emplace_back().mutable_unix()->set_path(folder_.file("hapticd.sock"));
    }
    ipc::Services services{.mailbox = *mailbox_,
                           .version = "9.9",
                           .rate_hz = 1000.0,
                           .devices = {},
                           .real_time = {},
                           .scene = example_scene(),
                           .running = std::make_shared<const engine::Scene>(),
                           .build_scene = build_example,
                           .edit_scene = edit_example,
                           .armed_changed = [this](bool armed) {
                             is_armed_ = armed;
                             ++armed_changes_;
                           }};
    services.on_poll = std::move(on_poll);
    v1::DeviceDescription& device = services.devices.emplace_back();
    device.set_name("left");
    device.set_driver("simulated");
    device.set_max_force(5.0);
    services.real_time.add_warning("SCHED_FIFO 80 was refused");
    server_ = std::make_unique<ipc::Server>(std::move(settings), std::move(services));
    thread_ = std::thread([this] { server_->run(); });
  }
  TestDaemon(const TestDaemon&) = delete;
  TestDaemon& operator=(const TestDaemon&) = delete;
  ~TestDaemon() { stop(); }

  void stop() {
    if (thread_.joinable()) {
      server_->stop();
      thread_.join();
    }
  }

  FakeServo& servo() noexcept { return servo_; }
  servo::Mailbox& mailbox() noexcept { return *mailbox_; }
  ipc::Server& server() noexcept { return *server_; }
  /// What it told of arming, and how often.
  bool is_armed() const noexcept { return is_armed_; }
  int armed_changes() const noexcept { return armed_changes_; }
  const std::string& address() const noexcept { return server_->addresses().front(); }
  const TemporaryFolder& folder() const noexcept { return folder_; }

 private:
  TemporaryFolder folder_;
  std::unique_ptr<servo::Mailbox> mailbox_;
  FakeServo servo_;
  std::atomic<bool> is_armed_{false};
  std::atomic<int> armed_changes_{0};
  std::unique_ptr<ipc::Server> server_;
  std::thread thread_;
};

/// Settings in which everybody has this role, whoever runs the test.
inline ipc::ServerSettings with_role(std::optional<v1::Role> role) {
  ipc::ServerSettings settings;
  settings.role_of = [role](const ipc::PeerCredentials&) { return role; };
  return settings;
}

}  // namespace haptic::test
