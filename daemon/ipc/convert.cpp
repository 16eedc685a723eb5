#include "ipc/convert.h"

#include <array>
#include <cstdio>

#include "safety/limits.h"

namespace haptic::ipc {
namespace {

static_assert(safety::kLimitForce == 1U << v1::LIMIT_FORCE && safety::kLimitRate == 1U << v1::LIMIT_RATE &&
              safety::kLimitRamp == 1U << v1::LIMIT_RAMP &&
              safety::kLimitMeanForce == 1U << v1::LIMIT_MEAN_FORCE &&
              safety::kLimitClutch == 1U << v1::LIMIT_CLUTCH);

constexpr std::array<const char*, servo::kStages> kStageNames = {"commands", "read",    "step", "guard",
                                                                 "write",    "publish", "tick"};

const char* words_of(v1::FaultKind kind) noexcept {
  switch (kind) {
    case v1::FAULT_NOT_FINITE:
      return "a force or a pose that is no number";
    case v1::FAULT_OVER_SPEED:
      return "over speed";
    case v1::FAULT_STALE_SAMPLE:
      return "no new sample";
    case v1::FAULT_MISSED_TICKS:
      return "missed ticks";
    case v1::FAULT_LOST_DRIVER:
      return "lost driver";
    case v1::FAULT_OVER_TRAVEL:
      return "over travel";
    case v1::FAULT_ENERGY:
      return "too much energy given to the user";
    case v1::FAULT_EMERGENCY_STOP:
      return "emergency stop";
    case v1::FAULT_STILL_SAMPLE:
      return "the same position all the time";
    case v1::FAULT_LOST_DEVICE:
      return "lost device";
    default:
      return "fault";
  }
}

const char* unit_of(v1::FaultKind kind) noexcept {
  switch (kind) {
    case v1::FAULT_OVER_SPEED:
      return " m/s";
    case v1::FAULT_STALE_SAMPLE:
    case v1::FAULT_LOST_DRIVER:
    case v1::FAULT_STILL_SAMPLE:
      return " s";
    case v1::FAULT_OVER_TRAVEL:
      return " m";
    case v1::FAULT_ENERGY:
      return " J";
    default:
      return "";
  }
}

}  // namespace

v1::ConstraintState to_wire(engine::ConstraintState state) noexcept {
  switch (state) {
    case engine::ConstraintState::kTet:
      return v1::TET;
    case engine::ConstraintState::kSur:
      return v1::SUR;
    case engine::ConstraintState::kEdg:
      return v1::EDG;
    case engine::ConstraintState::kVer:
      return v1::VER;
    case engine::ConstraintState::kOut:
      break;
  }
  return v1::OUT;
}

v1::FaultKind to_wire(safety::FaultKind kind) noexcept {
  switch (kind) {
    case safety::FaultKind::kNone:
      return v1::FAULT_NONE;
    case safety::FaultKind::kNotFinite:
      return v1::FAULT_NOT_FINITE;
    case safety::FaultKind::kOverSpeed:
      return v1::FAULT_OVER_SPEED;
    case safety::FaultKind::kStaleSample:
      return v1::FAULT_STALE_SAMPLE;
    case safety::FaultKind::kMissedTicks:
      return v1::FAULT_MISSED_TICKS;
    case safety::FaultKind::kOverTravel:
      return v1::FAULT_OVER_TRAVEL;
    case safety::FaultKind::kEnergy:
      return v1::FAULT_ENERGY;
    case safety::FaultKind::kEmergencyStop:
      return v1::FAULT_EMERGENCY_STOP;
    case safety::FaultKind::kStillSample:
      return v1::FAULT_STILL_SAMPLE;
    case safety::FaultKind::kLostDevice:
      return v1::FAULT_LOST_DEVICE;
    case safety::FaultKind::kLostDriver:
      break;
  }
  return v1::FAULT_LOST_DRIVER;
}

v1::DevicePhase to_wire(drivers::DevicePhase phase) noexcept {
  switch (phase) {
    case drivers::DevicePhase::kFound:
      return v1::DEVICE_FOUND;
    case drivers::DevicePhase::kOpening:
      return v1::DEVICE_OPENING;
    case drivers::DevicePhase::kHoming:
      return v1::DEVICE_HOMING;
    case drivers::DevicePhase::kReady:
      return v1::DEVICE_READY;
    case drivers::DevicePhase::kAbsent:
      break;
  }
  return v1::DEVICE_ABSENT;
}

v1::DevicePhase phase_of(const servo::DeviceSnapshot& device) noexcept {
  if (device.phase != drivers::DevicePhase::kReady) return to_wire(device.phase);
  if (device.fault.kind != safety::FaultKind::kNone) return v1::DEVICE_FAULT;
  if (!device.present) return v1::DEVICE_ABSENT;
  return device.armed ? v1::DEVICE_ARMED : v1::DEVICE_READY;
}

v1::Fault to_wire(const safety::Fault& fault, std::span<const v1::DeviceDescription> devices) {
  v1::Fault out;
  out.set_kind(to_wire(fault.kind));
  if (fault.device < devices.size()) {
    out.set_device(devices[fault.device].name());
  }
  out.set_tick(fault.tick);
  out.set_value(fault.value);
  out.set_limit(fault.limit);
  return out;
}

std::string in_words(const v1::Fault& fault) {
  std::string text = fault.device().empty() ? "" : fault.device() + ": ";
  text += words_of(fault.kind());
  // a side of a box may be at any coordinate
  if (fault.limit() > 0.0 || fault.kind() == v1::FAULT_OVER_TRAVEL) {
    std::array<char, 96> numbers{};
    const char* unit = unit_of(fault.kind());
    std::snprintf(numbers.data(), numbers.size(), ", %.3g%s where %.3g%s is allowed", fault.value(), unit,
                  fault.limit(), unit);
    text += numbers.data();
  }
  return text;
}

v1::Histogram to_wire(const std::string& name, const rt::LatencyHistogram& histogram) {
  v1::Histogram out;
  out.set_name(name);
  // no bin after the last that counts anything
  std::size_t bins = rt::LatencyHistogram::kBins;
  while (bins > 0 && histogram.count(bins - 1) == 0) {
    --bins;
  }
  for (std::size_t bin = 0; bin < bins; ++bin) {
    out.add_upper_ns(rt::LatencyHistogram::upper_ns(bin));
    out.add_count(histogram.count(bin));
  }
  out.set_total(histogram.total());
  out.set_max_ns(histogram.max_ns());
  out.set_mean_ns(histogram.mean_ns());
  out.set_p50_ns(histogram.quantile_ns(0.5));
  out.set_p99_ns(histogram.quantile_ns(0.99));
  out.set_p999_ns(histogram.quantile_ns(0.999));
  return out;
}

v1::Stats to_wire(const servo::LoopStats& stats, double rate_hz, std::uint64_t lost_snapshots) {
  v1::Stats out;
  out.set_tick(stats.tick);
  out.set_rate_hz(rate_hz);
  out.set_missed_ticks(stats.missed_ticks);
  out.set_lost_snapshots(lost_snapshots);
  *out.mutable_wakeup() = to_wire("wakeup", stats.wakeup);
  for (std::size_t i = 0; i < servo::kStages; ++i) {
    *out.add_stage() = to_wire(kStageNames[i], stats.stages[i]);
  }
  const engine::TransitionTable& table = stats.transitions;
  for (std::size_t before = 0; before < engine::kConstraintStates; ++before) {
    for (std::size_t after = 0; after < engine::kConstraintStates; ++after) {
      const auto from = static_cast<engine::ConstraintState>(before);
      const auto to = static_cast<engine::ConstraintState>(after);
      if (!engine::is_permitted(from, to)) {
        continue;
      }
      v1::TransitionStats& transition = *out.add_transition();
      transition.set_before(to_wire(from));
      transition.set_after(to_wire(to));
      transition.set_count(table.count[before][after]);
      if (const std::uint64_t timed = table.timed[before][after]; timed > 0) {
        transition.set_mean_ns(static_cast<double>(table.nanoseconds[before][after]) /
                               static_cast<double>(timed));
      }
    }
  }
  out.set_limited_hips(table.limited);
  out.set_relocations(table.relocations);
  return out;
}

v1::Error make_error(v1::Error::Code code, const std::string& message) {
  v1::Error error;
  error.set_code(code);
  error.set_message(message);
  return error;
}

}  // namespace haptic::ipc
