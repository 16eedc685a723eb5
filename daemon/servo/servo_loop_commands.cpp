// What the tick does with commands. Every command is answered by exactly one event.

#include "safety/magnitude.h"
#include "servo/servo_loop.h"

namespace haptic::servo {

namespace {

// a command is only taken when there is room for all that may come of it (its answer, and a retired scene,
// a latched fault or the answer to a step), so that neither an answer nor memory to free is ever lost; a copy
// waits until there is room for it
constexpr std::size_t kEventsPerCommand = 2;

constexpr std::uint64_t kForever = ~std::uint64_t{0};

}  // namespace

void ServoLoop::receive_commands(const Instant& now) noexcept {
  Command command;
  for (std::size_t i = 0; i < kCommandsPerTick; ++i) {
    if (mailbox_.events.write_available() < kEventsPerCommand || !mailbox_.commands.pop(command)) return;
    obey(command, now);
  }
}

void ServoLoop::obey(const Command& command, const Instant& now) noexcept {
  EventKind answer = EventKind::kDone;
  WaitingForce waiting;
  switch (command.kind) {
    case CommandKind::kArm:
      answer = arm(waiting);
      break;
    case CommandKind::kDisarm:
      if (!armed_) answer = EventKind::kNothingToDo;
      disarm();
      break;
    case CommandKind::kPause:
      if (paused_) answer = EventKind::kNothingToDo;
      paused_ = true;
      break;
    case CommandKind::kResume:
      answer = resume(now);
      break;
    case CommandKind::kStep:
      if (paused_) {
        // of two steps that overlap the first is answered now, and both run
        if (step_unanswered_) answer_step(now);
        begin_step(command);
        note(command, EventKind::kDone);
        return;
      }
      answer = EventKind::kNothingToDo;
      break;
    case CommandKind::kReset:
      scene_->world.reset();
      restart_ramps();
      break;
    case CommandKind::kClearFault:
      answer = clear_fault();
      break;
    case CommandKind::kSwapScene:
      answer = swap_scene(command.scene, now);
      break;
    case CommandKind::kResetStats:
      stats_ = {};
      scene_->world.clear_transitions();
      break;
    case CommandKind::kLatchFault:
      answer = latch_gently(command.fault, now);
      break;
    case CommandKind::kCopyState:
      begin_copy(command, now);
      return;
    case CommandKind::kEmergencyStop:
      stop_emergency(now);
      break;
  }
  note(command, answer);
  send({.kind = answer,
        .command = command.kind,
        .request = command.request,
        .fault = fault_,
        .waiting = waiting},
       now);
}

/// Whether force waits for a device that would be armed now.
bool ServoLoop::find_waiting_force(WaitingForce& waiting) noexcept {
  // as the last tick left the world, even if that is paused: what comes when it goes on is told now
  want_forces();
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    const Channel& channel = channels_[i];
    if (!channel.is_ready() || channel.guard.armed() || !channel.device->info().exerts_force) continue;
    const double force = safety::length(channel.wanted.force);
    const double limit = channel.guard.limits().max_arm_force;
    if (force <= limit) continue;
    waiting = {.device = static_cast<std::uint32_t>(i), .force = force, .limit = limit};
    return true;
  }
  return false;
}

EventKind ServoLoop::arm(WaitingForce& waiting) noexcept {
  if (has_fault()) return EventKind::kFaultRefused;
  if (armed_ && !can_arm_more()) return EventKind::kNothingToDo;
  if (find_waiting_force(waiting)) return EventKind::kForceWaits;
  armed_ = true;
  // one that is plugged in later gets no force until somebody arms again
  for (Channel& channel : channels_) {
    if (channel.is_ready()) channel.guard.arm();
  }
  return EventKind::kDone;
}

EventKind ServoLoop::resume(const Instant& now) noexcept {
  if (!paused_) return EventKind::kNothingToDo;
  paused_ = false;
  steps_left_ = 0;
  // hands have moved meanwhile
  restart_ramps();
  if (step_unanswered_) answer_step(now);
  return EventKind::kDone;
}

EventKind ServoLoop::clear_fault() noexcept {
  if (!has_fault()) return EventKind::kNothingToDo;
  fault_ = {};
  cut_ = false;
  for (Channel& channel : channels_) {
    channel.guard.clear();
    channel.has_told_fault = false;
  }
  return EventKind::kDone;
}

EventKind ServoLoop::latch_gently(safety::Fault fault, const Instant& now) noexcept {
  if (!armed_) return EventKind::kNothingToDo;
  fault.tick = now.tick;
  fault_ = fault;
  armed_ = false;
  for (Channel& channel : channels_) channel.guard.latch_gently(fault);
  send({.kind = EventKind::kFaultLatched, .fault = fault}, now);
  return EventKind::kDone;
}

EventKind ServoLoop::swap_scene(PreparedScene* scene, const Instant& now) noexcept {
  const std::optional<Carry>& carry = scene->carry;
  const bool taken = !carry || (carry->from_revision == scene_->revision &&
                                scene->world.carry_over(scene_->world, carry->map));
  PreparedScene* retired = scene;
  if (taken) {
    retired = scene_.release();
    scene_.reset(scene);
    // an edit leaves what a hand holds as it is, and the slew limit sees to the rest
    if (!carry) restart_ramps();
  }
  send({.kind = EventKind::kSceneRetired, .command = CommandKind::kSwapScene, .scene = retired}, now);
  return taken ? EventKind::kDone : EventKind::kOutdated;
}

void ServoLoop::restart_ramps() noexcept {
  for (Channel& channel : channels_) channel.guard.restart_ramp();
}

void ServoLoop::begin_step(const Command& command) noexcept {
  const std::uint64_t ticks = command.ticks == 0 ? 1 : command.ticks;
  steps_left_ = ticks > kForever - steps_left_ ? kForever : steps_left_ + ticks;
  step_request_ = command.request;
  step_unanswered_ = true;
}

void ServoLoop::finish_step(const Instant& now) noexcept {
  if (paused_ && steps_left_ > 0) --steps_left_;
  const bool room = mailbox_.events.write_available() > 0;
  if (step_unanswered_ && steps_left_ == 0 && room) answer_step(now);
}

void ServoLoop::answer_step(const Instant& now) noexcept {
  step_unanswered_ = false;
  send({.kind = EventKind::kDone, .command = CommandKind::kStep, .request = step_request_}, now);
}

void ServoLoop::begin_copy(const Command& command, const Instant& now) noexcept {
  if (copy_ == nullptr && command.copy->revision == scene_->revision) {
    copy_.reset(command.copy);
    copy_request_ = command.request;
    return;
  }
  send({.kind = EventKind::kOutdated,
        .command = CommandKind::kCopyState,
        .request = command.request,
        .copy = command.copy},
       now);
}

void ServoLoop::finish_copy(const Instant& now) noexcept {
  if (copy_ == nullptr || mailbox_.events.write_available() == 0) return;
  // a scene that was swapped in meanwhile may be of other sizes, and then copying would allocate
  const bool fits = copy_->revision == scene_->revision;
  if (fits) {
    copy_->state = scene_->world.state();
    copy_->paused = paused_;
    copy_->steps_left = steps_left_;
  }
  send({.kind = fits ? EventKind::kDone : EventKind::kOutdated,
        .command = CommandKind::kCopyState,
        .request = copy_request_,
        .copy = copy_.release()},
       now);
}

void ServoLoop::note(const Command& command, EventKind answer) noexcept {
  if (answer != EventKind::kDone) return;
  switch (command.kind) {
    case CommandKind::kPause:
    case CommandKind::kResume:
    case CommandKind::kReset:
      inputs_.commands[inputs_.command_count++] = {.kind = command.kind};
      break;
    case CommandKind::kStep:
      inputs_.commands[inputs_.command_count++] = {.kind = command.kind, .ticks = command.ticks};
      break;
    case CommandKind::kSwapScene:
      inputs_.commands[inputs_.command_count++] = {.kind = command.kind, .revision = scene_->revision};
      break;
    default:
      break;  // about force, or about what is told
  }
}

}  // namespace haptic::servo
