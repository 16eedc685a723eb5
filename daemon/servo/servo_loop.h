#pragma once
// The tick, as one sentence: commands, devices, HIPs, world, guard, devices, snapshot. The same tick runs on
// the servo thread of the service and on the virtual clock of `hapticd simulate`.

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "drivers/device.h"
#include "engine/constraint.h"
#include "safety/force_guard.h"
#include "servo/mailbox.h"
#include "servo/motion_filter.h"
#include "servo/workspace.h"

namespace haptic::servo {

/// When a tick runs.
struct Instant {
  std::uint64_t tick = 0;         // servo periods since start; skipped ones count
  drivers::Nanoseconds time = 0;  // the servo's clock at the start of the period
  std::uint64_t missed = 0;       // periods slept through just before this one
  std::uint64_t lateness_ns = 0;  // of the wake-up
};

/// What is set for one device alone.
struct DeviceSettings {
  safety::DeviceLimits limits{};
  WorkspaceSettings workspace{};
  MotionFilterSettings filter{};
  std::optional<std::uint32_t> stop_button{};  // 0 to 31; pressing it is an emergency stop
  bool stops_alone = false;                    // its loss stops no other
};

struct ServoSettings {
  double rate_hz = 1000.0;
  safety::GuardLimits limits;             // of every device
  std::vector<DeviceSettings> devices{};  // in their order; of those beyond its end nothing is set
  std::uint32_t max_missed_ticks = 50;    // in a row, while armed
  bool armed_from_start = false;          // only `simulate`, where no hand is near
  bool paused_from_start = false;         // only a replay that starts in the middle,
  std::uint64_t steps_from_start = 0;     // and how many steps were left there
  engine::Clock clock = nullptr;          // for stage and transition times; none: nothing is timed
};

class ServoLoop {
 public:
  /// Devices must outlive the loop and be started. The scene is owned from now on.
  ServoLoop(const ServoSettings& settings, std::span<drivers::Device* const> devices,
            std::unique_ptr<PreparedScene> scene, Mailbox& mailbox);
  ~ServoLoop();

  ServoLoop(const ServoLoop&) = delete;
  ServoLoop& operator=(const ServoLoop&) = delete;

  /// One tick. Real-time safe.
  void tick(const Instant& now) noexcept;

  // For the owner of the thread that ticks, between ticks.

  /// The scene that runs now.
  const PreparedScene& scene() const noexcept { return *scene_; }
  /// Wants no force from now on, as the command does. Real-time safe.
  void disarm() noexcept;
  /// No device was given any force in the last tick.
  bool is_at_rest() const noexcept;
  /// The latched fault, if any.
  const safety::Fault& fault() const noexcept { return fault_; }

 private:
  /// A device with what this tick knows of it.
  struct Channel {
    drivers::Device* device;
    safety::ForceGuard guard;
    Workspace workspace;
    MotionFilter filter;
    std::optional<std::uint32_t> stop_button{};
    bool stops_alone = false;  // when it is lost
    drivers::DeviceState state{};
    drivers::DeviceSample hand{};    // as it was measured, with the velocity of the filter
    drivers::DeviceSample sample{};  // the same in the world
    glm::dvec3 acceleration{0.0};    // m/s^2, world
    bool sampled = false;            // there was a sample at some time
    bool fresh = false;              // and it is not too old
    bool was_fresh = false;          // in the tick before
    double sample_age = 0.0;         // s
    bool has_told_fault = false;     // that is its own alone
    engine::Wrench wanted{};         // by the engine, on the hand, world's axes
    safety::GuardOutput let_through{};

    bool is_ready() const noexcept { return state.phase == drivers::DevicePhase::kReady; }
  };

  static Channel make_channel(const ServoSettings& settings, drivers::Device& device, std::size_t index);
  void receive_commands(const Instant& now) noexcept;
  void read_devices(const Instant& now) noexcept;
  void find_losses(const Instant& now) noexcept;
  void place_fingers() noexcept;
  void step_world() noexcept;
  void guard_forces(const Instant& now) noexcept;
  void write_devices(const Instant& now) noexcept;
  void publish(const Instant& now) noexcept;

  void obey(const Command& command, const Instant& now) noexcept;
  EventKind arm(WaitingForce& waiting) noexcept;
  bool find_waiting_force(WaitingForce& waiting) noexcept;
  bool can_arm_more() const noexcept;
  bool has_fault() const noexcept;
  EventKind resume(const Instant& now) noexcept;
  EventKind clear_fault() noexcept;
  EventKind latch_gently(safety::Fault fault, const Instant& now) noexcept;
  void stop_emergency(const Instant& now) noexcept;
  EventKind swap_scene(PreparedScene* scene, const Instant& now) noexcept;
  void restart_ramps() noexcept;
  void begin_step(const Command& command) noexcept;
  void finish_step(const Instant& now) noexcept;
  void answer_step(const Instant& now) noexcept;
  void begin_copy(const Command& command, const Instant& now) noexcept;
  void finish_copy(const Instant& now) noexcept;
  void note(const Command& command, EventKind answer) noexcept;

  void measure(Channel& channel, const Instant& now) noexcept;
  void want_forces() noexcept;
  void latch(const safety::Fault& fault, const Instant& now) noexcept;
  bool keeps_its_fault(Channel& channel, const Instant& now) noexcept;
  void send(Event event, const Instant& now) noexcept;

  void count_misses(const Instant& now) noexcept;
  void fill(Snapshot& snapshot, const Instant& now) const noexcept;
  void publish_stats(const Instant& now) noexcept;
  void finish_stage(Stage stage) noexcept;

  ServoSettings settings_;
  double dt_;
  drivers::Nanoseconds force_lifetime_;
  std::vector<Channel> channels_;
  std::unique_ptr<PreparedScene> scene_;
  Mailbox& mailbox_;

  bool armed_ = false;
  bool paused_;
  std::uint64_t steps_left_;  // while paused
  bool step_unanswered_ = false;
  std::uint64_t step_request_ = 0;  // to be answered when none is left
  safety::Fault fault_;
  bool cut_ = false;  // by a fault: no device gets any force

  TickInputs inputs_;
  std::unique_ptr<StateCopy> copy_;  // to be filled and handed back when the tick has run
  std::uint64_t copy_request_ = 0;

  std::uint64_t ticks_run_ = 0;
  std::uint64_t missed_ticks_ = 0;
  LoopStats stats_;
  std::uint64_t tick_started_ns_ = 0;
  std::uint64_t stage_started_ns_ = 0;
};

}  // namespace haptic::servo
