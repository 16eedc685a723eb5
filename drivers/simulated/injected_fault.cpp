#include "drivers/simulated/injected_fault.h"

#include <algorithm>
#include <cmath>

namespace haptic::drivers {

namespace {

constexpr std::size_t kMostKept = 8192;  // kLongestDelay at 8 kHz, the highest rate of the servo

// in whole nanoseconds, so that the tick of a time in decimals is not a matter of rounding
bool is_active(const InjectedFault& fault, Nanoseconds elapsed) noexcept {
  const auto since = static_cast<double>(elapsed) - std::round(fault.at * 1e9);
  return since >= 0.0 && since < std::round(fault.duration * 1e9);
}

}  // namespace

FaultInjector::FaultInjector(std::span<const InjectedFault> faults) {
  faults_.reserve(faults.size());
  for (const InjectedFault& fault : faults) faults_.push_back({.fault = fault});
  const bool delays = std::any_of(faults.begin(), faults.end(), [](const InjectedFault& fault) {
    return fault.kind == InjectedKind::kDelay;
  });
  if (delays) kept_.resize(kMostKept);
}

void FaultInjector::start() noexcept {
  for (Active& one : faults_) one = {.fault = one.fault};
  kept_count_ = 0;
  last_time_.reset();
  unplugged_ = false;
}

bool FaultInjector::pass(Nanoseconds elapsed, DeviceSample& sample) noexcept {
  const Nanoseconds now = sample.time;
  if (!kept_.empty()) keep(sample);
  unplugged_ = false;
  bool arrives = true;
  for (Active& one : faults_) {
    const bool active = is_active(one.fault, elapsed);
    if (!change(one, active, now, sample)) arrives = false;
    if (active && one.fault.kind == InjectedKind::kUnplug) unplugged_ = true;
    one.active = active;
  }
  last_time_ = now;
  return arrives;
}

void FaultInjector::keep(const DeviceSample& sample) noexcept {
  kept_[kept_count_ % kMostKept] = sample;
  ++kept_count_;
}

bool FaultInjector::change(Active& one, bool active, Nanoseconds now, DeviceSample& sample) const noexcept {
  switch (one.fault.kind) {
    case InjectedKind::kDrop:
    case InjectedKind::kUnplug:
      return !active;
    case InjectedKind::kDelay:
      return delay(one, active, now, sample);
    case InjectedKind::kFreeze:
      if (!active) return true;
      if (!one.active) one.frozen = sample;
      sample.position = one.frozen.position;
      sample.orientation = one.frozen.orientation;
      sample.velocity = glm::dvec3(0.0);
      return true;
    case InjectedKind::kNotANumber:
      if (active) sample.position.x = std::numeric_limits<double>::quiet_NaN();
      return true;
    case InjectedKind::kJump:
      if (active) sample.position += one.fault.offset;
      // as a driver that tells velocity from positions would
      if (active != one.active && last_time_ && now > *last_time_) {
        const double sign = active ? 1.0 : -1.0;
        sample.velocity += sign * one.fault.offset / (static_cast<double>(now - *last_time_) * 1e-9);
      }
      return true;
  }
  return true;
}

// the place in the ring moves on in every tick, so that none has to search
bool FaultInjector::delay(Active& one, bool active, Nanoseconds now, DeviceSample& sample) const noexcept {
  const Nanoseconds wanted = now - static_cast<Nanoseconds>(one.fault.delay * 1e9);
  const std::uint64_t oldest = kept_count_ - std::min<std::uint64_t>(kept_count_, kMostKept);
  one.delayed = std::max(one.delayed, oldest);
  while (one.delayed + 1 < kept_count_ && kept_[(one.delayed + 1) % kMostKept].time <= wanted) ++one.delayed;
  if (!active) return true;
  sample = kept_[one.delayed % kMostKept];
  return sample.time <= wanted;
}

}  // namespace haptic::drivers
