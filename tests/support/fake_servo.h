#pragma once
// Stands at the servo thread's end of a mailbox: answers commands as the real one would, and publishes the
// snapshots that a test makes up.

#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "servo/mailbox.h"

namespace haptic::test {

class FakeServo {
 public:
  explicit FakeServo(servo::Mailbox& mailbox) : mailbox_(mailbox) {
    thread_ = std::jthread([this](const std::stop_token& stop) {
      while (!stop.stop_requested()) {
        pump();
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
    });
  }

  /// From now on commands stay in their queue.
  void freeze() {
    const std::lock_guard lock(mutex_);
    frozen_ = true;
  }

  /// A fault, as the guard would latch it.
  void latch(const safety::Fault& fault) {
    const std::lock_guard lock(mutex_);
    fault_ = fault;
    armed_ = false;
    mailbox_.events.push({.kind = servo::EventKind::kFaultLatched, .tick = tick_, .fault = fault_});
  }

  /// From now on this keeps it from being armed; none: nothing does.
  void let_force_wait(const std::optional<servo::WaitingForce>& waiting) {
    const std::lock_guard lock(mutex_);
    waiting_ = waiting;
  }

  void miss_ticks(std::uint64_t count) {
    const std::lock_guard lock(mutex_);
    mailbox_.events.push({.kind = servo::EventKind::kTicksMissed, .tick = tick_, .count = count});
  }

  /// Publishes one tick; `fill` adds what it has beside what the servo knows.
  void publish(std::uint64_t tick, const std::function<void(servo::Snapshot&)>& fill = {}) {
    const std::lock_guard lock(mutex_);
    tick_ = tick;
    servo::Snapshot& snapshot = mailbox_.snapshots.writable();
    snapshot.tick = tick;
    snapshot.monotonic_ns = tick * 1'000'000;
    snapshot.scene_revision = scene_ ? scene_->revision : 1;
    snapshot.armed = armed_;
    snapshot.paused = paused_;
    snapshot.missed_ticks = 0;
    snapshot.objects.clear();
    snapshot.hips.clear();
    snapshot.contacts.clear();
    snapshot.devices.clear();
    if (fill) {
      fill(snapshot);
    }
    mailbox_.snapshots.publish();
  }

  std::vector<servo::CommandKind> seen() const {
    const std::lock_guard lock(mutex_);
    return seen_;
  }

 private:
  void pump() {
    const std::lock_guard lock(mutex_);
    servo::Command command;
    while (!frozen_ && mailbox_.commands.pop(command)) {
      seen_.push_back(command.kind);
      const servo::EventKind answer = obey(command);
      mailbox_.events.push({.kind = answer,
                            .command = command.kind,
                            .request = command.request,
                            .tick = tick_,
                            .fault = fault_,
                            .waiting = waiting_.value_or(servo::WaitingForce()),
                            .copy = command.copy});
    }
  }

  servo::EventKind obey(const servo::Command& command) {
    switch (command.kind) {
      case servo::CommandKind::kArm:
        if (fault_.kind != safety::FaultKind::kNone) {
          return servo::EventKind::kFaultRefused;
        }
        return waiting_ ? servo::EventKind::kForceWaits : set(armed_, true);
      case servo::CommandKind::kDisarm:
        return set(armed_, false);
      case servo::CommandKind::kPause:
        return set(paused_, true);
      case servo::CommandKind::kResume:
        return set(paused_, false);
      case servo::CommandKind::kStep:
        return paused_ ? servo::EventKind::kDone : servo::EventKind::kNothingToDo;
      case servo::CommandKind::kClearFault:
        if (fault_.kind == safety::FaultKind::kNone) {
          return servo::EventKind::kNothingToDo;
        }
        fault_ = {};
        return servo::EventKind::kDone;
      case servo::CommandKind::kLatchFault:
        if (!armed_) {
          return servo::EventKind::kNothingToDo;
        }
        armed_ = false;
        fault_ = command.fault;
        mailbox_.events.push({.kind = servo::EventKind::kFaultLatched, .tick = tick_, .fault = fault_});
        return servo::EventKind::kDone;
      case servo::CommandKind::kEmergencyStop:
        armed_ = false;
        fault_ = {.kind = safety::FaultKind::kEmergencyStop, .tick = tick_};
        mailbox_.events.push({.kind = servo::EventKind::kFaultLatched, .tick = tick_, .fault = fault_});
        return servo::EventKind::kDone;
      case servo::CommandKind::kSwapScene:
        mailbox_.events.push(
            {.kind = servo::EventKind::kSceneRetired, .command = command.kind, .scene = scene_.release()});
        scene_.reset(command.scene);
        return servo::EventKind::kDone;
      default:
        return servo::EventKind::kDone;
    }
  }

  static servo::EventKind set(bool& flag, bool value) {
    const bool was = flag;
    flag = value;
    return was == value ? servo::EventKind::kNothingToDo : servo::EventKind::kDone;
  }

  servo::Mailbox& mailbox_;
  mutable std::mutex mutex_;
  bool frozen_ = false;
  bool armed_ = false;
  bool paused_ = false;
  std::uint64_t tick_ = 0;
  safety::Fault fault_;
  std::optional<servo::WaitingForce> waiting_;
  std::unique_ptr<servo::PreparedScene> scene_;
  std::vector<servo::CommandKind> seen_;
  std::jthread thread_;
};

}  // namespace haptic::test
