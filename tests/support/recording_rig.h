#pragma once
// A servo loop whose telemetry is kept as a recording keeps it: scenes, states and the frame of each tick.
// Two fingertips close on a loose box of wood, hold it and carry it about; the paths are a function of the
// tick alone.

#include <google/protobuf/text_format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "daemon/scene_builder.h"
#include "haptic/v1/control.pb.h"
#include "ipc/encode.h"
#include "load/config_file.h"
#include "load/state_message.h"
#include "replay/replayer.h"
#include "servo/prepare_scene.h"
#include "servo/servo_loop.h"
#include "tests/support/servo_rig.h"

namespace haptic::test {

inline v1::Scene grasp_scene() {
  v1::Scene scene;
  if (!google::protobuf::TextFormat::ParseFromString(R"(
        name: "grasp"
        gravity { y: -0.98 }
        material { name: "wood" density: 500 rigid { static_friction: 1 kinetic_friction: 0.5 } }
        material { name: "air" free {} }
        object {
          name: "box" shape { box { size { x: 0.08 y: 0.03 z: 0.03 } } } inside: "wood" outside: "air"
          air_margin: 0.02 dynamic { linear_viscosity: 0.8 angular_viscosity: 1e-4 release_after: 0.2 }
        }
        finger {
          name: "thumb" device: "left" stiffness: 100
          fingertip { radius: 0.008 cap_angle: 0.5 hips: 4 direction { z: 1 } }
        }
        finger {
          name: "index" device: "right" stiffness: 100
          fingertip { radius: 0.008 cap_angle: 0.5 hips: 4 direction { z: -1 } }
        })",
                                                     &scene)) {
    throw std::runtime_error("the scene of the test is not right");
  }
  return scene;
}

/// What a recording holds, in its order.
using Item = std::variant<v1::SceneDescription, v1::WorldState, v1::Frame>;

class RecordingRig {
 public:
  RecordingRig() {
    ipc::BuiltScene built = ask(load(grasp_scene()));
    loop_ = std::make_unique<servo::ServoLoop>(servo::ServoSettings{.limits = wide_limits()},
                                               std::vector<drivers::Device*>{&left_, &right_},
                                               std::move(built.prepared), *mailbox_);
  }

  const std::vector<Item>& items() const { return items_; }
  std::vector<Item>& items() { return items_; }
  const engine::World& world() const { return loop_->scene().world; }
  HandDevice& left() { return left_; }

  void tick(int count = 1, std::uint64_t missed = 0) {
    for (int i = 0; i < count; ++i) {
      next_ += missed;
      move_hands();
      loop_->tick(
          {.tick = next_, .time = static_cast<drivers::Nanoseconds>(next_ * 1'000'000), .missed = missed});
      ++next_;
      v1::Frame frame;
      ipc::fill_frame(*mailbox_->snapshots.take(), ipc::kTickTopics, {}, 0, frame);
      items_.emplace_back(std::move(frame));
      take_events();
    }
  }

  void send(servo::CommandKind kind, std::uint64_t ticks = 0) {
    mailbox_->commands.push({.kind = kind, .ticks = ticks});
  }

  /// A tick after which the state is recorded.
  void tick_and_copy() {
    servo::Command command;
    command.kind = servo::CommandKind::kCopyState;
    command.copy = servo::copy_buffer(world().scene(), loop_->scene().revision).release();
    mailbox_->commands.push(command);
    tick();
  }

  void load_scene(const v1::Scene& scene) { swap(ask(load(scene))); }

  void edit(const std::string& edit) {
    v1::EditScene request;
    google::protobuf::TextFormat::ParseFromString(edit, &request);
    swap(ask([&] { return builder_.from_edit(request, running_); }));
  }

 private:
  std::function<ipc::BuiltScene()> load(const v1::Scene& scene) {
    return [this, scene] {
      v1::LoadScene request;
      *request.mutable_scene() = scene;
      return builder_.from_request(request);
    };
  }

  ipc::BuiltScene ask(const std::function<ipc::BuiltScene()>& build) {
    ipc::BuiltScene built = build();
    built.prepared->revision = ++revision_;
    built.description.set_revision(revision_);
    running_ = {built.description.scene(), built.prepared->world.shared_scene(), revision_};
    items_.emplace_back(built.description);
    return built;
  }

  void swap(ipc::BuiltScene built) {
    servo::Command command;
    command.kind = servo::CommandKind::kSwapScene;
    command.scene = built.prepared.release();
    mailbox_->commands.push(command);
  }

  void take_events() {
    mailbox_->events.consume_all([&](const servo::Event& event) {
      const std::unique_ptr<servo::PreparedScene> retired(event.scene);
      const std::unique_ptr<servo::StateCopy> copy(event.copy);
      if (!copy) return;
      v1::WorldState& state = std::get<v1::WorldState>(items_.emplace_back(v1::WorldState()));
      state.set_tick(event.tick);
      state.set_scene_revision(copy->revision);
      state.set_rate_hz(1000.0);
      state.add_device("left");
      state.add_device("right");
      state.set_paused(copy->paused);
      state.set_steps_left(copy->steps_left);
      haptic::load::write_state(copy->state, state);
    });
  }

  void move_hands() {
    const auto tick = static_cast<double>(next_);
    const double gap = 0.045 - 0.029 * std::min(1.0, tick / 200.0);
    const double turn = 0.01 * std::max(0.0, tick - 300.0);
    const glm::dvec3 middle{0.03 + 0.02 * std::sin(turn), 0.02 * (1.0 - std::cos(turn)), 0.0};
    left_.sample.position = middle - glm::dvec3{0.0, 0.0, gap};
    right_.sample.position = middle + glm::dvec3{0.0, 0.0, gap};
  }

  SceneBuilder builder_{haptic::load::default_capacity(), {"left", "right"}};
  HandDevice left_{"left"};
  HandDevice right_{"right"};
  std::unique_ptr<servo::Mailbox> mailbox_ = std::make_unique<servo::Mailbox>(
      servo::Capacity{.objects = 8, .fingers = 4, .hips = 64, .contacts = 64, .devices = 2});
  std::unique_ptr<servo::ServoLoop> loop_;
  ipc::RunningScene running_;
  std::uint64_t revision_ = 0;
  std::uint64_t next_ = 0;
  std::vector<Item> items_;
};

inline replay::Report replay_all(const std::vector<Item>& items) {
  replay::Replayer replayer;
  for (const Item& item : items) {
    if (const auto* scene = std::get_if<v1::SceneDescription>(&item)) replayer.add_scene(*scene);
    if (const auto* state = std::get_if<v1::WorldState>(&item)) replayer.take(*state);
    if (const auto* frame = std::get_if<v1::Frame>(&item)) replayer.take(*frame);
  }
  return replayer.report();
}

}  // namespace haptic::test
