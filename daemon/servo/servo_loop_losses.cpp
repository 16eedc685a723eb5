// What the tick does when a device is lost: its driver told so, or, as the second net, its samples stopped.

#include <algorithm>

#include "servo/servo_loop.h"

namespace haptic::servo {

void ServoLoop::find_losses(const Instant& now) noexcept {
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    Channel& channel = channels_[i];
    const drivers::DeviceState state = channel.device->state();
    // it may have come back since the last tick
    const bool was_lost = state.losses != channel.state.losses;
    const bool is_ready = state.phase == drivers::DevicePhase::kReady;
    channel.state = state;
    if (is_ready && !was_lost) continue;
    channel.fresh = channel.was_fresh = false;
    if (!channel.guard.armed()) continue;
    const safety::Fault fault{
        .kind = safety::FaultKind::kLostDevice, .device = static_cast<std::uint32_t>(i), .tick = now.tick};
    if (channel.stops_alone) {
      channel.guard.latch(fault);
    } else {
      latch(fault, now);
    }
  }
}

/// Whether the fault that cuts this device leaves the others alone. It is told, once.
bool ServoLoop::keeps_its_fault(Channel& channel, const Instant& now) noexcept {
  const safety::Fault& fault = channel.guard.fault();
  const bool is_loss =
      fault.kind == safety::FaultKind::kLostDevice || fault.kind == safety::FaultKind::kStaleSample;
  const bool is_own = fault.device < channels_.size() && &channels_[fault.device] == &channel;
  if (!channel.stops_alone || !is_loss || !is_own) return false;
  if (!channel.has_told_fault) send({.kind = EventKind::kFaultLatched, .fault = fault}, now);
  channel.has_told_fault = true;
  return true;
}

bool ServoLoop::has_fault() const noexcept {
  return fault_.kind != safety::FaultKind::kNone ||
         std::any_of(channels_.begin(), channels_.end(), [](const Channel& channel) {
           return channel.guard.fault().kind != safety::FaultKind::kNone;
         });
}

bool ServoLoop::can_arm_more() const noexcept {
  return std::any_of(channels_.begin(), channels_.end(),
                     [](const Channel& channel) { return channel.is_ready() && !channel.guard.armed(); });
}

}  // namespace haptic::servo
