#include "replay/replayer.h"

#include <utility>

#include "engine/world.h"
#include "load/config_file.h"
#include "load/ranges.h"
#include "load/scene_file.h"
#include "load/state_message.h"
#include "replay/state_difference.h"
#include "servo/prepare_scene.h"

namespace haptic::replay {

namespace {

constexpr drivers::Nanoseconds kTickTime = 1'000'000;  // any will do: what a tick computes knows no time
// no state of more can have been recorded: proto::kReplyLimit
constexpr std::size_t kMostContacts = std::size_t{1} << 21U;
constexpr load::Range kRates{100.0, 8000.0, " Hz"};

// more than any config permits: what was built once must be built again
v1::Capacity any_capacity() {
  v1::Capacity capacity;
  capacity.set_objects(65536);
  capacity.set_fingers(4096);
  capacity.set_hips(262144);
  return capacity;
}

[[noreturn]] void fail(const std::string& field, const std::string& message) {
  throw load::LoadError({.file = {}, .line = 0, .column = 0, .field = field}, message);
}

engine::CarryMap carry_map(const v1::SceneDescription::Carry& carry) {
  engine::CarryMap map;
  map.objects.reserve(static_cast<std::size_t>(carry.object_size()));
  for (const auto& object : carry.object()) {
    map.objects.push_back({.from = object.has_from() ? object.from() : engine::kNone,
                           .motion = object.motion(),
                           .contacts = object.contacts()});
  }
  map.fingers.reserve(static_cast<std::size_t>(carry.finger_size()));
  for (const auto& finger : carry.finger()) {
    map.fingers.push_back(finger.has_from() ? finger.from() : engine::kNone);
  }
  return map;
}

void check_size(int size, const char* field, std::size_t devices, std::size_t each) {
  if (static_cast<std::size_t>(size) == devices * each) return;
  fail(std::string("inputs.") + field, "has " + std::to_string(size) + " items where " +
                                           std::to_string(devices) + " devices have " +
                                           std::to_string(devices * each));
}

}  // namespace

Replayer::Replayer() = default;
Replayer::~Replayer() = default;

void Replayer::add_scene(v1::SceneDescription scene) {
  const std::uint64_t revision = scene.revision();
  scenes_.insert_or_assign(revision, std::move(scene));
}

void Replayer::take(const v1::WorldState& state) {
  if (report_.difference) return;
  if (loop_ && state.tick() <= tick_) {
    const engine::World& world = loop_->scene().world;
    if (state.tick() == tick_) compare(state.state_hash(), engine::hash(world.state()), v1::Frame());
    return;
  }
  load::check_range({}, "state.rate_hz", state.rate_hz(), kRates);
  load::check_range({}, "state.device", state.device_size(), {0, load::kMostDevices, " devices"});

  loop_.reset();
  names_.assign(state.device().begin(), state.device().end());
  devices_.clear();
  devices_.reserve(names_.size());
  std::vector<drivers::Device*> pointers;
  pointers.reserve(names_.size());
  for (const std::string& name : names_) {
    devices_.push_back(std::make_unique<RecordedDevice>(name));
    pointers.push_back(devices_.back().get());
  }
  loaded_.reset();
  std::unique_ptr<servo::PreparedScene> scene = build(state.scene_revision());
  scene->carry.reset();
  const engine::State start = load::read_state(state, scene->world.scene());
  if (engine::hash(start) != state.state_hash()) fail("state.state_hash", "is not that of the state");
  scene->world.restore(start);

  // of the snapshots only the hash is used
  mailbox_ = std::make_unique<servo::Mailbox>(
      servo::Capacity{.objects = 0, .fingers = 0, .hips = 0, .contacts = 0, .devices = 0});
  const servo::ServoSettings settings{.rate_hz = state.rate_hz(),
                                      .limits = {},
                                      .paused_from_start = state.paused(),
                                      .steps_from_start = state.steps_left()};
  loop_ = std::make_unique<servo::ServoLoop>(settings, pointers, std::move(scene), *mailbox_);
  tick_ = state.tick();
  ++report_.starts;
}

void Replayer::take(const v1::Frame& frame) {
  if (!frame.has_inputs() || report_.difference) return;
  if (!loop_) {
    if (report_.starts > 0) ++report_.unreachable;
    return;
  }
  if (frame.tick() <= tick_) return;
  const v1::InputsFrame& inputs = frame.inputs();
  if (frame.tick() - tick_ - 1 != inputs.missed()) {
    report_.gaps.push_back({.first_tick = tick_ + 1, .last_tick = frame.tick() - 1});
    ++report_.unreachable;
    loop_.reset();
    return;
  }
  check(inputs);
  feed(inputs);
  tick_ = frame.tick();
  loop_->tick({.tick = tick_,
               .time = static_cast<drivers::Nanoseconds>(report_.ticks) * kTickTime,
               .missed = inputs.missed()});
  answer();
  if (report_.ticks == 0) report_.first_tick = tick_;
  ++report_.ticks;
  report_.last_tick = tick_;
  const std::uint64_t replayed = mailbox_->snapshots.take()->inputs.state_hash;
  if (!inputs.has_state_hash()) return;
  ++report_.compared;
  compare(inputs.state_hash(), replayed, frame);
}

void Replayer::check(const v1::InputsFrame& inputs) const {
  check_size(inputs.position_size(), "position", devices_.size(), 3);
  check_size(inputs.orientation_size(), "orientation", devices_.size(), 4);
  check_size(inputs.velocity_size(), "velocity", devices_.size(), 3);
  check_size(inputs.present_size(), "present", devices_.size(), 1);
  if (static_cast<std::size_t>(inputs.command_size()) > servo::kCommandsPerTick) {
    fail("inputs.command", "has more items than one tick takes (permitted: up to " +
                               std::to_string(servo::kCommandsPerTick) + ")");
  }
}

void Replayer::feed(const v1::InputsFrame& inputs) {
  for (std::size_t i = 0; i < devices_.size(); ++i) {
    const int device = static_cast<int>(i);
    const auto position = [&](int axis) { return inputs.position(3 * device + axis); };
    const auto orientation = [&](int axis) { return inputs.orientation(4 * device + axis); };
    const auto velocity = [&](int axis) { return inputs.velocity(3 * device + axis); };
    devices_[i]->measure({.time = 0,
                          .position = {position(0), position(1), position(2)},
                          .orientation = {orientation(0), orientation(1), orientation(2), orientation(3)},
                          .velocity = {velocity(0), velocity(1), velocity(2)},
                          .buttons = 0},
                         inputs.present(device));
  }
  for (const v1::InputsFrame::Command& command : inputs.command()) send(command);
}

void Replayer::send(const v1::InputsFrame::Command& command) {
  servo::Command sent;
  switch (command.kind()) {
    case v1::InputsFrame::PAUSE:
      sent.kind = servo::CommandKind::kPause;
      break;
    case v1::InputsFrame::RESUME:
      sent.kind = servo::CommandKind::kResume;
      break;
    case v1::InputsFrame::STEP:
      sent.kind = servo::CommandKind::kStep;
      sent.ticks = command.ticks();
      break;
    case v1::InputsFrame::RESET:
      sent.kind = servo::CommandKind::kReset;
      break;
    case v1::InputsFrame::SCENE:
      sent.kind = servo::CommandKind::kSwapScene;
      sent.scene = build(command.scene_revision()).release();
      break;
    default:
      fail("inputs.command", "this version does not know the command " + std::to_string(command.kind()));
  }
  mailbox_->commands.push(sent);
}

std::unique_ptr<servo::PreparedScene> Replayer::build(std::uint64_t revision) {
  const auto found = scenes_.find(revision);
  if (found == scenes_.end()) {
    fail("scene_revision", "the recording has no scene of revision " + std::to_string(revision));
  }
  const v1::SceneDescription& description = found->second;
  // an edited scene shares the cells of the one before: what HIPs hold is told by their numbers
  std::optional<load::Built> before;
  if (loaded_ && description.has_carry()) before.emplace(load::Built{loaded_->message, loaded_->scene});
  loaded_ = load::build_scene(description.scene(), load::TextSource(), nullptr, any_capacity(),
                              before ? &*before : nullptr);
  const std::shared_ptr<const engine::Scene> scene(loaded_, &loaded_->scene);
  if (scene->objects.size() * scene->hip_count > kMostContacts) {
    fail("scene", "has " + std::to_string(scene->objects.size()) + " objects and " +
                      std::to_string(scene->hip_count) + " HIPs, too many to be replayed");
  }
  std::unique_ptr<servo::PreparedScene> prepared = servo::prepare_scene(scene, revision, names_);
  if (description.has_carry()) {
    prepared->carry = servo::Carry{.from_revision = description.carry().from_revision(),
                                   .map = carry_map(description.carry())};
  }
  return prepared;
}

void Replayer::answer() const {
  std::optional<std::uint64_t> refused;
  mailbox_->events.consume_all([&](const servo::Event& event) {
    const std::unique_ptr<servo::PreparedScene> retired(event.scene);
    if (event.kind == servo::EventKind::kOutdated) refused = tick_;
  });
  if (refused) fail("inputs.command", "the scene cannot take over from the one that runs in the replay");
}

void Replayer::compare(std::uint64_t recorded, std::uint64_t replayed, const v1::Frame& frame) {
  if (recorded == replayed) return;
  const servo::PreparedScene& scene = loop_->scene();
  report_.difference = Difference{.tick = tick_,
                                  .scene_revision = scene.revision,
                                  .recorded = recorded,
                                  .replayed = replayed,
                                  .where = find_difference(frame, scene.world)};
}

}  // namespace haptic::replay
