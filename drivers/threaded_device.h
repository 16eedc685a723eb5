#pragma once
// A Device whose hardware needs I/O: it looks for the hardware, opens it, runs a driver's routine on it, and
// looks for it again when it is lost, as often as that happens. The servo meets it through a DeviceLink. A
// driver writes the routine; threads, ends, failures and waiting are handled here, once.
//
//                    +---------------- plugged in, or the time is up ----------------+
//                    v                                                               |
//     absent --> open() --throws--> absent, or found and why it cannot be opened --> wait
//                    |
//                    +--> opening --> [homing] --> ready --lost--> found --> left alone for a while
//
// Looking and opening take long and are no work for a real-time priority: they run on an ordinary thread, and
// only run() on a real-time one.

#include <atomic>
#include <chrono>
#include <memory>
#include <string>
#include <thread>

#include "drivers/device.h"
#include "drivers/device_life.h"
#include "drivers/device_link.h"
#include "drivers/plug_monitor.h"
#include "drivers/reconnection.h"

namespace haptic::drivers {

/// Whether a routine shall end. Any thread.
class StopFlag {
 public:
  void raise() noexcept { raised_.store(true, std::memory_order_release); }
  void lower() noexcept { raised_.store(false, std::memory_order_release); }
  bool is_raised() const noexcept { return raised_.load(std::memory_order_acquire); }

 private:
  std::atomic<bool> raised_{false};
};

/// What a driver does. Its functions are called one after the other: prepare() and release() on the thread of
/// start() and stop(), the others on the device's own.
class DeviceRoutine {
 public:
  virtual ~DeviceRoutine() = default;

  /// Makes what does not depend on the hardware being there. Throws DeviceError: then start() fails.
  virtual void prepare() {}

  /// Finds and opens the device. Throws DeviceAbsent if it is not there, DeviceError if it cannot be opened,
  /// and leaves nothing open then. What takes long looks at stop_requested() or calls go_on() meanwhile.
  virtual void open() = 0;

  /// Serves the device until `stop` is raised, which it looks at every 100 ms at least; then, and on every
  /// other way out, outputs zero force. Throws DeviceError if the device is lost. The first sample that it
  /// publishes makes the device ready.
  virtual void run(DeviceLink& link, const StopFlag& stop) = 0;

  /// Closes what open() opened, whatever has become of it.
  virtual void close() noexcept = 0;

  /// Ends what prepare() made.
  virtual void release() noexcept {}

  /// Tells when such a device may have been plugged in; none: it is only looked for now and then. Throws
  /// DeviceError if that cannot be told.
  virtual std::unique_ptr<PlugMonitor> make_monitor() { return nullptr; }

  /// What run() does when life().take() tells that it was asked for. kReopen is not the routine's.
  virtual bool knows(DeviceAction /*action*/) const noexcept { return false; }

  /// Called before anything else.
  void belong_to(DeviceLife& life, const StopFlag& stop) noexcept {
    life_ = &life;
    stop_ = &stop;
  }

 protected:
  /// For phases that only the driver knows (kOpening, kHoming), serials, and losses that do not end run().
  DeviceLife& life() const noexcept { return *life_; }
  bool stop_requested() const noexcept { return stop_->is_raised(); }
  /// Throws DeviceError if open() shall end.
  void go_on() const;

 private:
  DeviceLife* life_ = nullptr;
  const StopFlag* stop_ = nullptr;
};

class ThreadedDevice final : public Device {
 public:
  ThreadedDevice(DeviceInfo info, const BasePose& world_from_base, std::unique_ptr<DeviceRoutine> routine);
  ~ThreadedDevice() override;

  const DeviceInfo& info() const noexcept override { return info_; }
  void start() override;
  void stop() noexcept override;
  DeviceState state() const noexcept override { return life_.state(); }
  bool read(Nanoseconds now, DeviceSample& sample) noexcept override;
  void write(Nanoseconds now, const ForceCommand& command) noexcept override;
  DeviceWords words() const override { return life_.words(); }
  bool knows(DeviceAction action) const noexcept override;
  void request(DeviceAction action) noexcept override;

 private:
  enum class Ended { kStopped, kReopened, kLost };

  void live() noexcept;
  bool open();
  Ended serve(std::string& loss);
  void tell_loss(const std::string& loss, Reconnection::Wait wait);
  bool wait(Reconnection::Wait time, PlugMonitor* monitor);

  DeviceInfo info_;
  DeviceLife life_;
  DeviceLink link_;
  std::unique_ptr<DeviceRoutine> routine_;
  StopFlag stop_;      // all of it
  StopFlag stop_run_;  // what open() or run() does now
  int wake_ = -1;      // an eventfd, readable when waiting shall end
  std::thread thread_;
  Reconnection reconnection_;  // the device's thread's
};

}  // namespace haptic::drivers
