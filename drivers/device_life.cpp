#include "drivers/device_life.h"

#include <utility>

namespace haptic::drivers {

namespace {

std::uint32_t bit_of(DeviceAction action) noexcept {
  return std::uint32_t{1} << static_cast<std::uint32_t>(action);
}

}  // namespace

DeviceWords DeviceLife::words() const {
  const std::lock_guard lock(mutex_);
  DeviceWords words = words_;
  if (state().phase == DevicePhase::kReady) words.reason.clear();
  return words;
}

void DeviceLife::request(DeviceAction action) noexcept {
  requests_.fetch_or(bit_of(action), std::memory_order_relaxed);
}

void DeviceLife::tell(DevicePhase phase, std::string reason) {
  store({.phase = phase, .losses = state().losses}, std::move(reason));
}

void DeviceLife::tell_serial(std::string serial) {
  const std::lock_guard lock(mutex_);
  words_.serial = std::move(serial);
}

void DeviceLife::ready() noexcept {
  DeviceState now = state();
  if (now.phase == DevicePhase::kReady) return;
  now.phase = DevicePhase::kReady;
  state_.store(now, std::memory_order_release);
}

void DeviceLife::lose(DevicePhase phase, std::string reason) {
  store({.phase = phase, .losses = state().losses + 1}, std::move(reason));
}

bool DeviceLife::take(DeviceAction action) noexcept {
  const std::uint32_t bit = bit_of(action);
  if ((requests_.load(std::memory_order_relaxed) & bit) == 0) return false;
  return (requests_.fetch_and(~bit, std::memory_order_relaxed) & bit) != 0;
}

// first the phase: a loss must reach the servo whoever reads the words just now
void DeviceLife::store(DeviceState state, std::string reason) {
  state_.store(state, std::memory_order_release);
  const std::lock_guard lock(mutex_);
  words_.reason = std::move(reason);
}

}  // namespace haptic::drivers
