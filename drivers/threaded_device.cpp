#include "drivers/threaded_device.h"

#include <exception>
#include <system_error>
#include <utility>

#include "drivers/device_error.h"

namespace haptic::drivers {

namespace {

// above the servo's 80: the thread does microseconds of work at a time, and the servo waits for what it
// brings
constexpr int kPriority = 85;

}  // namespace

ThreadedDevice::ThreadedDevice(DeviceInfo info, const BasePose& world_from_base,
                               std::unique_ptr<DeviceRoutine> routine)
    : info_(std::move(info)), link_(world_from_base), routine_(std::move(routine)) {}

ThreadedDevice::~ThreadedDevice() { stop(); }

void ThreadedDevice::start() {
  if (thread_) return;
  try {
    routine_->open();
  } catch (const DeviceError& error) {
    throw DeviceError("device \"" + info_.name + "\": " + error.what());
  }
  stop_.lower();
  try {
    thread_ = std::make_unique<rt::RealtimeThread>(rt::RealtimeSettings{.priority = kPriority},
                                                   [this] { serve(); });
  } catch (const std::system_error& error) {
    routine_->close();
    throw DeviceError("device \"" + info_.name + "\": its thread cannot be made: " + error.what());
  }
}

void ThreadedDevice::stop() noexcept {
  if (!thread_) return;
  stop_.raise();
  thread_.reset();  // waits for the routine, which outputs zero on its way out
  routine_->close();
}

bool ThreadedDevice::read(Nanoseconds /*now*/, DeviceSample& sample) noexcept { return link_.read(sample); }

void ThreadedDevice::write(Nanoseconds now, const ForceCommand& command) noexcept {
  link_.write(now, command);
}

void ThreadedDevice::serve() noexcept {
  try {
    routine_->run(link_, stop_);
  } catch (const std::exception&) {
    // the device is lost: without a sample the servo takes it for absent, and forces go to zero
  }
  link_.publish_nothing();
}

}  // namespace haptic::drivers
