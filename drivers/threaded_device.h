#pragma once
// A Device whose hardware needs I/O: it runs a driver's routine on a thread of its own and lets the servo
// meet it through a DeviceLink. A driver writes the routine; threads, ends and failures are handled here,
// once.

#include <atomic>
#include <memory>
#include <string>

#include "drivers/device.h"
#include "drivers/device_link.h"
#include "rt/realtime_thread.h"

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

/// What a driver does. open() and close() run on the thread of start() and stop(), run() on the device's own.
class DeviceRoutine {
 public:
  virtual ~DeviceRoutine() = default;

  /// Finds and opens the device. Throws DeviceError, and leaves nothing open then.
  virtual void open() = 0;

  /// Serves the device until `stop` is raised, which it looks at every 100 ms at least; then, and on every
  /// other way out, outputs zero force. Throws DeviceError if the device is lost.
  virtual void run(DeviceLink& link, const StopFlag& stop) = 0;

  /// Closes what open() opened, whatever has become of it.
  virtual void close() noexcept = 0;
};

class ThreadedDevice final : public Device {
 public:
  ThreadedDevice(DeviceInfo info, const BasePose& world_from_base, std::unique_ptr<DeviceRoutine> routine);
  ~ThreadedDevice() override;

  const DeviceInfo& info() const noexcept override { return info_; }
  void start() override;
  void stop() noexcept override;
  bool read(Nanoseconds now, DeviceSample& sample) noexcept override;
  void write(Nanoseconds now, const ForceCommand& command) noexcept override;

 private:
  void serve() noexcept;

  DeviceInfo info_;
  DeviceLink link_;
  std::unique_ptr<DeviceRoutine> routine_;
  StopFlag stop_;
  std::unique_ptr<rt::RealtimeThread> thread_;
};

}  // namespace haptic::drivers
