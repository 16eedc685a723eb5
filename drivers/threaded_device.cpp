#include "drivers/threaded_device.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <system_error>
#include <utility>
#include <vector>

#include "drivers/device_error.h"
#include "rt/realtime_thread.h"
#include "rt/tick_clock.h"

namespace haptic::drivers {

namespace {

// above the servo's 80: the thread does microseconds of work at a time, and the servo waits for what it
// brings
constexpr int kPriority = 85;

std::string seconds(Reconnection::Wait time) {
  std::array<char, 32> text{};
  (void)std::snprintf(text.data(), text.size(), "%.3g s", static_cast<double>(time.count()) * 1e-3);
  return text.data();
}

}  // namespace

void DeviceRoutine::go_on() const {
  if (stop_requested()) throw DeviceError("opening it was ended");
}

ThreadedDevice::ThreadedDevice(DeviceInfo info, const BasePose& world_from_base,
                               std::unique_ptr<DeviceRoutine> routine)
    : info_(std::move(info)), link_(world_from_base, &life_), routine_(std::move(routine)) {
  routine_->belong_to(life_, stop_run_);
}

ThreadedDevice::~ThreadedDevice() { stop(); }

void ThreadedDevice::start() {
  if (thread_.joinable()) return;
  const std::string who = "device \"" + info_.name + "\": ";
  try {
    routine_->prepare();
  } catch (const DeviceError& error) {
    throw DeviceError(who + error.what());
  }
  stop_.lower();
  stop_run_.lower();
  reconnection_ = {};
  life_.tell(DevicePhase::kAbsent, "it is looked for");
  wake_ = ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  try {
    if (wake_ < 0) throw std::system_error(errno, std::generic_category());
    thread_ = std::thread([this] { live(); });
  } catch (const std::system_error& error) {
    if (wake_ >= 0) ::close(wake_);
    routine_->release();
    throw DeviceError(who + "its thread cannot be made: " + error.what());
  }
}

void ThreadedDevice::stop() noexcept {
  if (!thread_.joinable()) return;
  stop_.raise();
  stop_run_.raise();
  (void)::eventfd_write(wake_, 1);
  thread_.join();  // waits for the routine, which outputs zero on its way out
  ::close(wake_);
  wake_ = -1;
  routine_->release();
}

bool ThreadedDevice::read(Nanoseconds /*now*/, DeviceSample& sample) noexcept { return link_.read(sample); }

void ThreadedDevice::write(Nanoseconds now, const ForceCommand& command) noexcept {
  link_.write(now, command);
}

bool ThreadedDevice::knows(DeviceAction action) const noexcept {
  return action == DeviceAction::kReopen || routine_->knows(action);
}

void ThreadedDevice::request(DeviceAction action) noexcept {
  life_.request(action);
  if (action != DeviceAction::kReopen) return;
  stop_run_.raise();
  (void)::eventfd_write(wake_, 1);
}

void ThreadedDevice::live() noexcept {
  std::unique_ptr<PlugMonitor> monitor;
  try {
    monitor = routine_->make_monitor();
  } catch (const std::exception&) {
    // then it is looked for now and then
  }
  while (!stop_.is_raised()) {
    eventfd_t count = 0;
    (void)::eventfd_read(wake_, &count);
    life_.forget_requests();
    stop_run_.lower();
    if (stop_.is_raised()) break;  // it may have been raised in between
    try {
      // what was plugged in before is looked at now
      if (monitor) (void)monitor->take();
      if (!open()) {
        if (wait(reconnection_.not_opened(), monitor.get())) reconnection_.plugged_in();
        continue;
      }
      std::string loss;
      const Nanoseconds opened = rt::monotonic_ns();
      const Ended ended = serve(loss);
      if (ended == Ended::kReopened) reconnection_ = {};
      if (ended != Ended::kLost) continue;
      const auto pause = reconnection_.dropped(std::chrono::nanoseconds(rt::monotonic_ns() - opened));
      tell_loss(loss, pause);
      (void)wait(pause, nullptr);
    } catch (const std::exception& error) {
      // no memory for words, or no thread: it goes on when there is some
      link_.publish_nothing();
      (void)wait(kLongestSearchWait, nullptr);
    }
  }
  life_.tell(DevicePhase::kAbsent, "it is stopped");
}

bool ThreadedDevice::open() {
  try {
    routine_->open();
    if (life_.state().phase < DevicePhase::kOpening) {
      life_.tell(DevicePhase::kOpening, "it has not told its first sample yet");
    }
    return true;
  } catch (const DeviceAbsent& error) {
    life_.tell(DevicePhase::kAbsent, error.what());
  } catch (const DeviceError& error) {
    life_.tell(DevicePhase::kFound, error.what());
  }
  life_.tell_serial({});
  return false;
}

ThreadedDevice::Ended ThreadedDevice::serve(std::string& loss) {
  std::exception_ptr failure;
  try {
    rt::RealtimeThread thread(rt::RealtimeSettings{.priority = kPriority}, [&] {
      try {
        routine_->run(link_, stop_run_);
      } catch (...) {
        failure = std::current_exception();
      }
    });
    thread.join();
  } catch (const std::system_error&) {
    failure = std::current_exception();
  }
  const bool was_asked = stop_run_.is_raised();
  link_.publish_nothing();
  if (!was_asked) {
    // at once: words and closing may take their time
    life_.lose(DevicePhase::kFound, {});
  } else {
    life_.tell(DevicePhase::kAbsent, "it is closed");
  }
  life_.tell_serial({});
  routine_->close();
  if (was_asked) return stop_.is_raised() ? Ended::kStopped : Ended::kReopened;
  loss = "its driver gave it up";
  try {
    if (failure) std::rethrow_exception(failure);
  } catch (const std::exception& error) {
    loss = error.what();
  }
  return Ended::kLost;
}

void ThreadedDevice::tell_loss(const std::string& loss, Reconnection::Wait wait) {
  std::string reason = "it was lost: " + loss;
  if (reconnection_.drops() > 1) {
    reason += "; that was " + std::to_string(reconnection_.drops()) +
              " times in a row soon after it was opened, and it is opened again in " + seconds(wait) +
              ": look at its plugs and its power";
  }
  life_.tell(DevicePhase::kFound, std::move(reason));
}

/// Waits for `time`, or until stop() or a request ends it. True if `monitor` told that something was plugged
/// in.
bool ThreadedDevice::wait(Reconnection::Wait time, PlugMonitor* monitor) {
  const auto end = std::chrono::steady_clock::now() + time;
  for (;;) {
    std::vector<pollfd> ready{{.fd = wake_, .events = POLLIN, .revents = 0}};
    if (monitor != nullptr) {
      for (const int descriptor : monitor->descriptors()) {
        ready.push_back({.fd = descriptor, .events = POLLIN, .revents = 0});
      }
    }
    const auto left =
        std::chrono::ceil<std::chrono::milliseconds>(end - std::chrono::steady_clock::now()).count();
    if (left <= 0) return false;
    (void)::poll(ready.data(), ready.size(), static_cast<int>(left));
    if (ready[0].revents != 0) {
      eventfd_t count = 0;
      (void)::eventfd_read(wake_, &count);
      if (life_.take(DeviceAction::kReopen)) reconnection_ = {};
      return false;
    }
    const bool is_news =
        std::any_of(ready.begin() + 1, ready.end(), [](const pollfd& one) { return one.revents != 0; });
    if (is_news && monitor->take()) return true;
  }
}

}  // namespace haptic::drivers
