#include "ipc/drive_lease.h"

#include <spdlog/spdlog.h>

#include <utility>

namespace haptic::ipc {

std::optional<std::string> DriveLease::refusal(ClientId client) const {
  if (untold_) {
    return "the drive lease was just lost, and forces are still to go down";
  }
  if (holder_ && holder_->client != client) {
    return holder_->driver.name + " holds the drive lease";
  }
  return std::nullopt;
}

void DriveLease::acquire(ClientId client, Driver driver, std::chrono::milliseconds silence,
                         SteadyClock::time_point now) {
  holder_ = Holder{client, std::move(driver), silence, now};
}

bool DriveLease::release(ClientId client) {
  if (!holder_ || holder_->client != client) {
    return false;
  }
  holder_.reset();
  return true;
}

bool DriveLease::beat(ClientId client, SteadyClock::time_point now) {
  if (!holder_ || holder_->client != client) {
    return false;
  }
  holder_->last_sign = now;
  holder_->was_late = false;
  return true;
}

void DriveLease::forget(ClientId client, SteadyClock::time_point now) {
  if (holder_ && holder_->client == client) {
    lose({.kind = safety::FaultKind::kLostDriver}, "its connection ended", now);
  }
}

void DriveLease::poll(SteadyClock::time_point now) {
  tell_servo(now);
  if (!holder_ || now - holder_->last_sign <= holder_->silence) {
    return;
  }
  // this thread may have been late itself: what has come meanwhile is read between two polls
  if (!holder_->was_late) {
    holder_->was_late = true;
    return;
  }
  using Seconds = std::chrono::duration<double>;
  const double silent = Seconds(now - holder_->last_sign).count();
  const double permitted = Seconds(holder_->silence).count();
  lose({.kind = safety::FaultKind::kLostDriver, .value = silent, .limit = permitted},
       "no heartbeat came for " + std::to_string(holder_->silence.count()) + " ms", now);
}

void DriveLease::lose(const safety::Fault& fault, const std::string& how, SteadyClock::time_point now) {
  spdlog::warn("{} has lost the drive lease: {}", holder_->driver.name, how);
  holder_.reset();
  servo::Command command;
  switch (policy_.on_loss) {
    case v1::Drive::KEEP:
      return;
    case v1::Drive::DISARM:
      command.kind = servo::CommandKind::kDisarm;
      break;
    default:
      command.kind = servo::CommandKind::kLatchFault;
      command.fault = fault;
      break;
  }
  untold_ = command;
  tell_servo(now);
}

void DriveLease::tell_servo(SteadyClock::time_point now) {
  if (untold_ && servo_.submit(*untold_, now, [](Outcome) {})) {
    untold_.reset();
  }
}

}  // namespace haptic::ipc
