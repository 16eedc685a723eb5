#pragma once
// Every crossing between the servo thread and the rest of the daemon. All queues are single-producer
// single-consumer, all memory is reserved in the constructor, and nothing here waits. A Mailbox is large: it
// belongs on the heap.
//
//     io thread  -- Command -->  servo thread        bounded; a full queue refuses the request
//     io thread  <-- Event ---   servo thread        answers, faults, memory to free; a lost event is counted
//     io thread  <-- Snapshot -- servo thread        a ring; a slow io thread loses the oldest, counted
//     io thread  <-- LoopStats - servo thread        newest value

#include <array>
#include <atomic>
#include <boost/lockfree/spsc_queue.hpp>
#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "drivers/device.h"
#include "engine/carry_map.h"
#include "engine/constraint.h"
#include "engine/world.h"
#include "rt/latency_histogram.h"
#include "rt/triple_buffer.h"
#include "safety/fault.h"

namespace haptic::servo {

/// What an edited scene takes over from the one that runs.
struct Carry {
  std::uint64_t from_revision = 0;  // the scene that the map was made for
  engine::CarryMap map;
};

/// A scene that was built off the servo thread, with all the memory that running it needs.
struct PreparedScene {
  std::uint64_t revision = 0;
  engine::World world;
  std::vector<std::uint32_t> device_of_finger;   // index in the device set; kNoDevice: none has this name
  std::vector<engine::FingerPose> finger_poses;  // scratch of the tick
  std::optional<Carry> carry = std::nullopt;     // of an edited scene; none: it starts at its tick 0
};

/// A copy of what a tick changes: with the inputs of all later ticks it gives their states again. Made by
/// copy_buffer() off the servo thread, which only fills it.
struct StateCopy {
  std::uint64_t revision = 0;  // of the scene that it is for
  engine::State state;         // after the tick of the answer
  bool paused = false;
  std::uint64_t steps_left = 0;  // while paused
};

enum class CommandKind : std::uint8_t {
  kArm,
  kDisarm,
  kPause,
  kResume,
  kStep,   // `ticks` (0: one) while paused; answered when they have run
  kReset,  // the scene to its state before tick 0
  kClearFault,
  kSwapScene,  // `scene` becomes the one that runs; the one that does not comes back in kSceneRetired
  kResetStats,
  kLatchFault,     // `fault`, while armed: forces go down by the slew limit, and it is latched
  kCopyState,      // into `copy`, at the end of the tick; kOutdated if that is for another scene
  kEmergencyStop,  // see Mailbox::emergency_stop; the command is for the answer
};

struct Command {
  CommandKind kind = CommandKind::kDisarm;
  std::uint64_t request = 0;       // echoed in the answer
  std::uint64_t ticks = 0;         // kStep
  PreparedScene* scene = nullptr;  // kSwapScene: never null; owned by whoever holds the command
  safety::Fault fault{};           // kLatchFault; its tick is set when it is latched
  StateCopy* copy = nullptr;       // kCopyState: never null; comes back in the answer
};

enum class EventKind : std::uint8_t {
  kDone,          // answer to a command
  kNothingToDo,   // answer: it was so already
  kFaultRefused,  // answer: a fault is latched
  kOutdated,      // answer: another scene runs than the one that was edited
  kForceWaits,    // answer to kArm: `waiting` would push at once
  kFaultLatched,  // `fault`
  kTicksMissed,   // `count` periods were slept through
  kSceneRetired,  // `scene` is no longer used and is the receiver's to free
};

/// What keeps devices from being armed.
struct WaitingForce {
  std::uint32_t device = 0;
  double force = 0.0;  // N that the world would have on the hand
  double limit = 0.0;  // N that may wait
};

struct Event {
  EventKind kind = EventKind::kDone;
  CommandKind command = CommandKind::kDisarm;  // of an answer
  std::uint64_t request = 0;
  std::uint64_t tick = 0;
  std::uint64_t count = 0;
  safety::Fault fault{};  // the latched one, if any
  WaitingForce waiting{};
  PreparedScene* scene = nullptr;
  StateCopy* copy = nullptr;  // of the answer to kCopyState: the receiver's to free
};

/// Commands that one tick takes at most; others wait for the next.
inline constexpr std::size_t kCommandsPerTick = 8;

/// A command that changed what is simulated.
struct AppliedCommand {
  CommandKind kind = CommandKind::kPause;  // kPause, kResume, kStep, kReset or kSwapScene
  std::uint64_t ticks = 0;                 // kStep
  std::uint64_t revision = 0;              // kSwapScene: of the scene that runs since then
};

/// With what the devices measured, all that one tick's state follows from.
struct TickInputs {
  std::uint64_t missed = 0;                                 // periods slept through just before the tick
  std::array<AppliedCommand, kCommandsPerTick> commands{};  // in the order in which they were obeyed
  std::size_t command_count = 0;
  std::uint64_t state_hash = 0;  // engine::hash after the tick
};

struct ObjectSnapshot {
  glm::dvec3 position;          // of the object frame, m, world
  glm::dquat orientation;       // world_from_object
  glm::dvec3 velocity;          // of the centre of gravity, m/s, world
  glm::dvec3 angular_velocity;  // rad/s, world
  glm::dvec3 force;             // by HIPs, N, world
  glm::dvec3 torque;            // by HIPs, about the centre of gravity, N m, world
};

struct HipSnapshot {
  glm::dvec3 position;  // m, world
  glm::dvec3 force;     // N on the user, before the guard, world
};

/// An object that holds a HIP: its state is not Out.
struct ContactSnapshot {
  std::uint32_t hip;
  std::uint32_t object;
  engine::ConstraintState state;
  bool slipping;
  glm::dvec3 proxy;  // m, world
  glm::dvec3 force;  // N on the user, world
};

struct DeviceSnapshot {
  bool present;
  glm::dvec3 position;     // m, world
  glm::dquat orientation;  // world_from_device
  glm::dvec3 velocity;     // m/s, world
  glm::dvec3 force;        // N on the user, after the guard, world
  glm::dvec3 torque;       // N m on the user, about the device's origin, world
  double sample_age;       // s
  std::uint32_t buttons;
  std::uint32_t limits;  // safety::Limit bits
  safety::Fault fault;
  glm::dvec3 acceleration{0.0};  // m/s^2, world
  double mean_force = 0.0;       // N, running
  double energy = 0.0;           // J given to the user beyond what was taken, since it was armed
  bool clutched = false;         // its clutch is down
  drivers::DevicePhase phase = drivers::DevicePhase::kReady;
  bool armed = false;  // its force is allowed: not so of one that came after arming
};

/// One tick as the rest of the daemon sees it. The vectors have their capacity from the start and only change
/// size within it.
struct Snapshot {
  std::uint64_t tick = 0;
  std::uint64_t monotonic_ns = 0;
  std::uint64_t scene_revision = 0;
  bool armed = false;
  bool paused = false;
  std::uint64_t missed_ticks = 0;
  TickInputs inputs;
  std::vector<ObjectSnapshot> objects;
  std::vector<HipSnapshot> hips;
  std::vector<ContactSnapshot> contacts;
  std::vector<DeviceSnapshot> devices;
  std::uint64_t dropped_contacts = 0;  // beyond the capacity
};

/// What is reserved for snapshots; a scene that needs more is refused before it gets here.
struct Capacity {
  std::size_t objects = 256;
  std::size_t fingers = 64;
  std::size_t hips = 16384;
  std::size_t contacts = 16384;
  std::size_t devices = 16;
};

/// Snapshots from the servo thread to the io thread in the order of ticks. When the reader is too slow the
/// writer takes back the oldest one that was not read, and counts it. Wait-free on both sides.
///
/// Buffer n goes to slot n % kSlots by an atomic exchange. What comes out of the slot is the writer's again:
/// a buffer that was never read, or nothing, and then one lies in `returned_`. Between slots, reader and
/// writer there are kSlots + 2 buffers, so that one is always left.
class SnapshotRing {
 public:
  static constexpr std::size_t kSlots = 64;

  explicit SnapshotRing(const Capacity& capacity);

  /// Servo thread: the buffer to fill, empty but for its capacity.
  Snapshot& writable() noexcept { return *spare_; }
  /// Servo thread: hands over what writable() returned.
  void publish() noexcept;
  /// io thread: the oldest snapshot that is left, or nullptr. Valid until the next call.
  const Snapshot* take() noexcept;

  std::uint64_t lost() const noexcept { return lost_.load(std::memory_order_relaxed); }

 private:
  struct Buffer : Snapshot {
    std::uint64_t number = 0;  // of its publication
  };

  std::vector<Buffer> buffers_;
  std::array<std::atomic<Buffer*>, kSlots> slots_{};
  boost::lockfree::spsc_queue<Buffer*, boost::lockfree::capacity<kSlots + 2>> returned_;
  Buffer* spare_ = nullptr;  // servo thread's
  Buffer* taken_ = nullptr;  // io thread's
  std::atomic<std::uint64_t> published_{0};
  std::uint64_t next_read_ = 0;  // io thread's
  std::atomic<std::uint64_t> lost_{0};
};

/// The stages of a tick that are timed, in their order.
enum class Stage : std::uint8_t { kCommands, kRead, kStep, kGuard, kWrite, kPublish, kTick };
inline constexpr std::size_t kStages = 7;

/// Since the start or the last kResetStats.
struct LoopStats {
  std::uint64_t tick = 0;
  std::uint64_t missed_ticks = 0;
  std::uint64_t lost_events = 0;
  rt::LatencyHistogram wakeup;                       // lateness
  std::array<rt::LatencyHistogram, kStages> stages;  // kTick: the whole; nothing without a clock
  engine::TransitionTable transitions;               // of the running scene since it started or was reset
};

struct Mailbox {
  explicit Mailbox(const Capacity& capacity) : snapshots(capacity) {}
  /// Frees the scenes and copies that are still in the queues. After both threads have ended.
  ~Mailbox();

  boost::lockfree::spsc_queue<Command, boost::lockfree::capacity<256>> commands;
  boost::lockfree::spsc_queue<Event, boost::lockfree::capacity<1024>> events;
  SnapshotRing snapshots;
  rt::TripleBuffer<LoopStats> stats;
  /// io thread: true cuts all forces in the next tick, which takes it back, and latches the fault. However
  /// many commands wait.
  std::atomic<bool> emergency_stop{false};
};

}  // namespace haptic::servo
