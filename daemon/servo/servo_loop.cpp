#include "servo/servo_loop.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace haptic::servo {

namespace {

constexpr std::uint64_t kStatsTicks = 100;  // one publication for so many
constexpr std::uint64_t kTimedTicks = 64;   // transitions are timed in one of so many: the clock costs more
                                            // than most of them
constexpr double kShortestForceLifetime = 0.003;  // s
constexpr double kForceLifetimeTicks = 3.0;

bool is_finite(const drivers::DeviceSample& sample) noexcept {
  const glm::dvec3& p = sample.position;
  const glm::dvec3& v = sample.velocity;
  const glm::dquat& q = sample.orientation;
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z) && std::isfinite(v.x) &&
         std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(q.w) && std::isfinite(q.x) &&
         std::isfinite(q.y) && std::isfinite(q.z);
}

/// push_back within the capacity. False if there is none left.
template <class T>
bool add(std::vector<T>& values, const T& value) noexcept {
  if (values.size() == values.capacity()) return false;
  values.push_back(value);
  return true;
}

}  // namespace

ServoLoop::ServoLoop(const ServoSettings& settings, std::span<drivers::Device* const> devices,
                     std::unique_ptr<PreparedScene> scene, Mailbox& mailbox)
    : settings_(settings),
      dt_(1.0 / settings.rate_hz),
      force_lifetime_(static_cast<drivers::Nanoseconds>(
          std::max(kShortestForceLifetime, kForceLifetimeTicks / settings.rate_hz) * 1e9)),
      scene_(std::move(scene)),
      mailbox_(mailbox),
      paused_(settings.paused_from_start),
      steps_left_(settings.steps_from_start) {
  channels_.reserve(devices.size());
  for (std::size_t i = 0; i < devices.size(); ++i) {
    channels_.push_back(make_channel(settings, *devices[i], i));
  }
  if (!settings.armed_from_start) return;
  armed_ = true;
  for (Channel& channel : channels_) channel.guard.arm_at_once();
}

ServoLoop::~ServoLoop() = default;

ServoLoop::Channel ServoLoop::make_channel(const ServoSettings& settings, drivers::Device& device,
                                           std::size_t index) {
  const DeviceSettings own = index < settings.devices.size() ? settings.devices[index] : DeviceSettings();
  const drivers::DeviceInfo& info = device.info();
  const safety::DeviceLimits bears{.max_force = info.max_force,
                                   .max_mean_force = info.max_mean_force,
                                   .travel = {info.travel_min, info.travel_max}};
  return {.device = &device,
          .guard = safety::ForceGuard(strictest(strictest(settings.limits, own.limits), bears)),
          .workspace = Workspace(own.workspace),
          .filter = MotionFilter(own.filter, settings.rate_hz),
          .stop_button = own.stop_button,
          .stops_alone = own.stops_alone,
          .state = device.state()};
}

void ServoLoop::tick(const Instant& now) noexcept {
  if (settings_.clock != nullptr) stage_started_ns_ = tick_started_ns_ = settings_.clock();
  count_misses(now);
  if (mailbox_.emergency_stop.exchange(false, std::memory_order_acq_rel)) stop_emergency(now);
  receive_commands(now);
  finish_stage(Stage::kCommands);
  read_devices(now);
  find_losses(now);
  finish_stage(Stage::kRead);
  place_fingers();
  step_world();
  finish_stage(Stage::kStep);
  guard_forces(now);
  finish_stage(Stage::kGuard);
  write_devices(now);
  finish_stage(Stage::kWrite);
  publish(now);
  finish_step(now);
  finish_copy(now);
  finish_stage(Stage::kPublish);
  publish_stats(now);
}

void ServoLoop::disarm() noexcept {
  armed_ = false;
  for (Channel& channel : channels_) channel.guard.disarm();
}

bool ServoLoop::is_at_rest() const noexcept {
  constexpr glm::dvec3 kNothing(0.0);
  return std::all_of(channels_.begin(), channels_.end(), [&](const Channel& channel) {
    return channel.let_through.force == kNothing && channel.let_through.torque == kNothing;
  });
}

void ServoLoop::count_misses(const Instant& now) noexcept {
  inputs_.missed = now.missed;
  inputs_.command_count = 0;
  missed_ticks_ += now.missed;
  stats_.missed_ticks += now.missed;
  stats_.wakeup.record(now.lateness_ns);
  if (now.missed == 0) return;
  send({.kind = EventKind::kTicksMissed, .count = now.missed}, now);
  if (!armed_ || now.missed <= settings_.max_missed_ticks) return;
  latch({.kind = safety::FaultKind::kMissedTicks,
         .tick = now.tick,
         .value = static_cast<double>(now.missed),
         .limit = static_cast<double>(settings_.max_missed_ticks)},
        now);
}

void ServoLoop::read_devices(const Instant& now) noexcept {
  for (Channel& channel : channels_) {
    if (channel.device->read(now.time, channel.hand)) measure(channel, now);
    channel.was_fresh = channel.fresh;
    // a sample may have been measured after the period began
    const drivers::Nanoseconds age = now.time - channel.hand.time;
    channel.sample_age =
        channel.sampled ? static_cast<double>(std::max<drivers::Nanoseconds>(0, age)) * 1e-9 : 0.0;
    channel.fresh = channel.sampled && channel.sample_age <= settings_.limits.max_sample_age;
  }
}

void ServoLoop::measure(Channel& channel, const Instant& now) noexcept {
  channel.sampled = true;
  const Motion& motion = channel.filter.take(channel.hand);
  channel.hand.velocity = motion.velocity;
  // one that is no number reaches the guard, and nothing else
  channel.sample = is_finite(channel.hand) ? channel.workspace.to_world(channel.hand) : channel.hand;
  channel.acceleration = channel.workspace.to_world(motion.acceleration);
  const bool stop = channel.stop_button && ((channel.hand.buttons >> *channel.stop_button) & 1U) != 0;
  if (stop) stop_emergency(now);
}

void ServoLoop::place_fingers() noexcept {
  for (std::size_t f = 0; f < scene_->finger_poses.size(); ++f) {
    const std::uint32_t device = scene_->device_of_finger[f];
    engine::FingerPose& pose = scene_->finger_poses[f];
    pose.present = false;
    if (device >= channels_.size()) continue;
    const Channel& channel = channels_[device];
    pose.present = channel.fresh && is_finite(channel.sample);
    if (pose.present) pose.world_from_device = {channel.sample.position, channel.sample.orientation};
  }
}

void ServoLoop::step_world() noexcept {
  if (paused_ && steps_left_ == 0) return;
  const bool timed = ticks_run_ % kTimedTicks == 0;
  scene_->world.step(scene_->finger_poses, dt_, timed ? settings_.clock : nullptr);
}

void ServoLoop::want_forces() noexcept {
  for (Channel& channel : channels_) channel.wanted = {};
  const std::vector<engine::Wrench>& wrenches = scene_->world.state().finger_wrenches;
  for (std::size_t f = 0; f < wrenches.size(); ++f) {
    const std::uint32_t device = scene_->device_of_finger[f];
    if (device >= channels_.size()) continue;
    channels_[device].wanted.force += wrenches[f].force;
    channels_[device].wanted.torque += wrenches[f].torque;
  }
  for (Channel& channel : channels_) channel.wanted = channel.workspace.to_hand(channel.wanted);
}

void ServoLoop::guard_forces(const Instant& now) noexcept {
  want_forces();
  // a device drops a force that has expired, however late this tick is
  const double passed = dt_ * static_cast<double>(now.missed + 1);
  const double alive = std::min(1.0, static_cast<double>(force_lifetime_) * 1e-9 / passed);
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    Channel& channel = channels_[i];
    const safety::GuardInput input{
        .tick = now.tick,
        .device = static_cast<std::uint32_t>(i),
        // in the tick in which a sample becomes too old the guard still sees it, and may find a fault
        .present = channel.fresh || channel.was_fresh,
        .sample_age = channel.sample_age,
        .sample_time = channel.hand.time,
        .position = channel.hand.position,
        .place = channel.workspace.to_base(channel.hand.position),
        .orientation = channel.hand.orientation,
        .velocity = channel.hand.velocity,
        .force = paused_ ? glm::dvec3(0.0) : channel.wanted.force,
        .torque = paused_ ? glm::dvec3(0.0) : channel.wanted.torque,
        .clutched = channel.workspace.is_clutched(),
        .force_share = channel.device->info().exerts_force ? alive : 0.0};
    channel.let_through = channel.guard.guard(input, dt_);
    if (channel.guard.is_cut() && !keeps_its_fault(channel, now)) latch(channel.guard.fault(), now);
  }
  if (!cut_) return;
  // what one device did stops them all, and in this very tick
  for (Channel& channel : channels_) channel.let_through = {};
}

void ServoLoop::write_devices(const Instant& now) noexcept {
  for (Channel& channel : channels_) {
    channel.device->write(now.time, {.expires = now.time + force_lifetime_,
                                     .force = channel.let_through.force,
                                     .torque = channel.let_through.torque});
  }
}

void ServoLoop::latch(const safety::Fault& fault, const Instant& now) noexcept {
  if (cut_) return;
  cut_ = true;
  armed_ = false;
  for (Channel& channel : channels_) channel.guard.latch(fault);
  // forces may have been going down because of another fault: the first one is kept
  if (fault_.kind != safety::FaultKind::kNone) return;
  fault_ = fault;
  send({.kind = EventKind::kFaultLatched, .fault = fault}, now);
}

void ServoLoop::stop_emergency(const Instant& now) noexcept {
  latch({.kind = safety::FaultKind::kEmergencyStop, .tick = now.tick}, now);
}

void ServoLoop::send(Event event, const Instant& now) noexcept {
  event.tick = now.tick;
  if (!mailbox_.events.push(event)) ++stats_.lost_events;
}

void ServoLoop::publish(const Instant& now) noexcept {
  // always: no client can make a tick take longer
  inputs_.state_hash = engine::hash(scene_->world.state());
  fill(mailbox_.snapshots.writable(), now);
  mailbox_.snapshots.publish();
}

void ServoLoop::fill(Snapshot& snapshot, const Instant& now) const noexcept {
  const engine::Scene& scene = scene_->world.scene();
  const engine::State& state = scene_->world.state();
  snapshot.tick = now.tick;
  snapshot.monotonic_ns = static_cast<std::uint64_t>(now.time);
  snapshot.scene_revision = scene_->revision;
  snapshot.armed = armed_;
  snapshot.paused = paused_;
  snapshot.missed_ticks = missed_ticks_;
  snapshot.inputs = inputs_;
  snapshot.dropped_contacts = 0;

  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const engine::BodyState& body = state.bodies[i];
    add(snapshot.objects, {.position = body.world_from_object.position,
                           .orientation = body.world_from_object.orientation,
                           .velocity = body.velocity,
                           .angular_velocity = engine::angular_velocity(scene.objects[i].dynamics, body),
                           .force = body.applied.force,
                           .torque = body.applied.torque});
    for (std::size_t hip = 0; hip < scene.hip_count; ++hip) {
      const std::size_t contact = i * scene.hip_count + hip;
      const engine::Proxy& proxy = state.proxies[contact];
      if (proxy.state == engine::ConstraintState::kOut) continue;
      const bool added = add(snapshot.contacts, {.hip = static_cast<std::uint32_t>(hip),
                                                 .object = static_cast<std::uint32_t>(i),
                                                 .state = proxy.state,
                                                 .slipping = proxy.slipping,
                                                 .proxy = scene_->world.proxy_in_world(i, hip),
                                                 .force = state.contact_forces[contact]});
      if (!added) ++snapshot.dropped_contacts;
    }
  }
  for (std::size_t hip = 0; hip < scene.hip_count; ++hip) {
    add(snapshot.hips, {.position = state.hip_positions[hip], .force = state.hip_forces[hip]});
  }
  for (const Channel& channel : channels_) {
    add(snapshot.devices, {.present = channel.fresh,
                           .position = channel.sample.position,
                           .orientation = channel.sample.orientation,
                           .velocity = channel.sample.velocity,
                           .force = channel.let_through.force,
                           .torque = channel.let_through.torque,
                           .sample_age = channel.sample_age,
                           .buttons = channel.sample.buttons,
                           .limits = channel.let_through.limits,
                           .fault = channel.guard.fault(),
                           .acceleration = channel.acceleration,
                           .mean_force = channel.guard.mean_force(),
                           .energy = channel.guard.energy(),
                           .clutched = channel.workspace.is_clutched(),
                           .phase = channel.state.phase,
                           .armed = channel.guard.armed()});
  }
}

void ServoLoop::finish_stage(Stage stage) noexcept {
  if (settings_.clock == nullptr) return;
  const std::uint64_t now_ns = settings_.clock();
  stats_.stages[static_cast<std::size_t>(stage)].record(now_ns - stage_started_ns_);
  stage_started_ns_ = now_ns;
}

void ServoLoop::publish_stats(const Instant& now) noexcept {
  if (settings_.clock != nullptr) {
    stats_.stages[static_cast<std::size_t>(Stage::kTick)].record(settings_.clock() - tick_started_ns_);
  }
  if (++ticks_run_ % kStatsTicks != 0) return;
  stats_.tick = now.tick;
  stats_.transitions = scene_->world.transitions();
  mailbox_.stats.write(stats_);
}

}  // namespace haptic::servo
