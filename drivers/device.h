#pragma once
// The one interface between the servo loop and a device. The servo thread calls state(), read() and write()
// in every tick: they take a bounded time and touch no file, lock or allocator. A driver whose hardware needs
// I/O does it on a thread of its own and meets the servo by newest-value exchange (rt/triple_buffer.h); a
// device that is computed needs no thread.
//
// Times are nanoseconds of the servo's clock: CLOCK_MONOTONIC in the service, tick / rate in `hapticd
// simulate`. Poses and forces are in the world frame, SI units.

#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <string>

namespace haptic::drivers {

/// Nanoseconds of the servo's clock.
using Nanoseconds = std::int64_t;

/// What a device measured.
struct DeviceSample {
  Nanoseconds time = 0;                        // when it was measured
  glm::dvec3 position{0.0, 0.0, 0.0};          // of the device's origin, m
  glm::dquat orientation{1.0, 0.0, 0.0, 0.0};  // world_from_device
  glm::dvec3 velocity{0.0, 0.0, 0.0};          // m/s
  std::uint32_t buttons = 0;                   // bit n: button n is down
};

/// What a device shall do to the hand. After `expires` the driver itself outputs zero, whatever the servo
/// does.
struct ForceCommand {
  Nanoseconds expires = 0;
  glm::dvec3 force{0.0, 0.0, 0.0};   // N, on the user
  glm::dvec3 torque{0.0, 0.0, 0.0};  // N m, on the user, about the device's origin
};

/// What is fixed about a device.
struct DeviceInfo {
  std::string name;    // from the config
  std::string driver;  // e.g. "simulated"
  double max_force;    // N that it can bear; infinity if it sets no limit

  // beside that it may set limits of its own, infinite by default
  static constexpr double kNone = std::numeric_limits<double>::infinity();
  double max_mean_force = kNone;  // N that it can bear for ever
  glm::dvec3 travel_min{-kNone};  // m, its own frame: the box within which it may be given force
  glm::dvec3 travel_max{kNone};
  bool exerts_force = true;  // false: it has no motors, and what write() is told moves nothing
};

/// Where a device stands in its life, in the order in which it gets there.
enum class DevicePhase : std::uint8_t {
  kAbsent,   // it is looked for
  kFound,    // it is there, and waits to be opened: it was lost a moment ago, or cannot be opened
  kOpening,  // and until it tells its first sample
  kHoming,   // it must be moved to where its position is known
  kReady,    // its samples count
};

/// What the servo must know of a device's life beside its sample. (Aligned to its size, so that an atomic one
/// is free of locks from every compiler.)
struct alignas(8) DeviceState {
  DevicePhase phase = DevicePhase::kReady;
  std::uint32_t losses = 0;  // times that it was lost since the daemon's start
};

/// The rest of it, for a person.
struct DeviceWords {
  std::string reason;  // why it is not ready, and how to mend that; empty if it is
  std::string serial;  // of the hardware that is open, if it tells one
};

/// What a person asks of a device.
enum class DeviceAction : std::uint8_t {
  kIdentify,   // it shows which one it is
  kHome,       // its position does not count until it has been homed again
  kCalibrate,  // it is in its rest pose now
  kReopen,     // it is closed, looked for and opened again
};

class Device {
 public:
  virtual ~Device() = default;

  virtual const DeviceInfo& info() const noexcept = 0;

  /// Starts the device's thread, if it has one, which looks for the hardware and opens it when it is there.
  /// Throws DeviceError for what no plugging-in can mend. Not real-time safe.
  virtual void start() = 0;

  /// Outputs zero force, ends the thread, closes the device. Not real-time safe.
  virtual void stop() noexcept = 0;

  /// Where it stands; one that is computed is always there. Any thread; real-time safe.
  virtual DeviceState state() const noexcept { return {}; }

  /// The newest sample. False if there is none yet, or the device is gone. `now` is the tick's time. Servo
  /// thread only.
  virtual bool read(Nanoseconds now, DeviceSample& sample) noexcept = 0;

  /// The force until the next tick. Servo thread only.
  virtual void write(Nanoseconds now, const ForceCommand& command) noexcept = 0;

  // For the io thread: not real-time safe, and they may wait for the device's thread for a moment.

  virtual DeviceWords words() const { return {}; }
  virtual bool knows(DeviceAction /*action*/) const noexcept { return false; }
  /// Asks the device's thread for what it knows. Only while nothing may push: nobody waits for it.
  virtual void request(DeviceAction /*action*/) noexcept {}
};

}  // namespace haptic::drivers
