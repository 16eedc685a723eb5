#include "safety/force_guard.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "safety/magnitude.h"

namespace haptic::safety {

ForceGuard::ForceGuard(const GuardLimits& limits) noexcept
    : limits_(limits),
      mean_force_(limits.max_mean_force, limits.mean_force_time),
      energy_(limits.max_energy) {}

bool ForceGuard::arm() noexcept {
  if (fault_.kind != FaultKind::kNone) return false;
  if (!armed_) {
    ramp_ = 0.0;
    energy_.reset();
  }
  armed_ = true;
  return true;
}

void ForceGuard::arm_at_once() noexcept {
  if (!arm()) return;
  ramp_ = 1.0;
}

void ForceGuard::disarm() noexcept { armed_ = false; }

void ForceGuard::latch(const Fault& fault) noexcept {
  latch_gently(fault);
  cut_ = true;
}

void ForceGuard::latch_gently(const Fault& fault) noexcept {
  if (fault_.kind == FaultKind::kNone) fault_ = fault;
  armed_ = false;
}

void ForceGuard::clear() noexcept {
  fault_ = Fault{};
  cut_ = false;
}

void ForceGuard::latch_measured(FaultKind kind, const GuardInput& input, double value,
                                double limit) noexcept {
  latch({.kind = kind, .device = input.device, .tick = input.tick, .value = value, .limit = limit});
}

// what the force of the tick before has done
void ForceGuard::observe(const GuardInput& input, double dt) noexcept {
  const glm::dvec3 given = input.force_share * last_force_;
  const bool counts = armed_ && input.present && is_finite(input.position);
  mean_force_.take(length(given), dt);
  still_.take(input.tick, counts && given != glm::dvec3(0.0), input.position);
  if (counts) {
    energy_.take(given, dt, input.sample_time, input.position);
  } else {
    energy_.lose_place();
  }
}

bool ForceGuard::find_fault(const GuardInput& input, double dt) noexcept {
  const bool finite = is_finite(input.position) && is_finite(input.place) && is_finite(input.orientation) &&
                      is_finite(input.velocity) && is_finite(input.force) && is_finite(input.torque) &&
                      !std::isnan(input.sample_age);
  if (!finite) {
    latch_measured(FaultKind::kNotFinite, input, 0.0, 0.0);
  } else if (armed_ && input.present) {
    find_fault_of_motion(input, dt);
  }
  return cut_;
}

void ForceGuard::find_fault_of_motion(const GuardInput& input, double dt) noexcept {
  const double still = static_cast<double>(still_.ticks()) * dt;
  if (length(input.velocity) > limits_.max_speed) {
    latch_measured(FaultKind::kOverSpeed, input, length(input.velocity), limits_.max_speed);
  } else if (input.sample_age > limits_.max_sample_age) {
    latch_measured(FaultKind::kStaleSample, input, input.sample_age, limits_.max_sample_age);
  } else if (const std::optional<OverTravel> beyond = over_travel(limits_.travel, input.place)) {
    latch_measured(FaultKind::kOverTravel, input, beyond->coordinate, beyond->side);
  } else if (energy_.is_beyond()) {
    latch_measured(FaultKind::kEnergy, input, energy_.energy(), limits_.max_energy);
  } else if (still > limits_.max_still) {
    latch_measured(FaultKind::kStillSample, input, still, limits_.max_still);
  }
}

GuardOutput ForceGuard::guard(const GuardInput& input, double dt) noexcept {
  observe(input, dt);
  GuardOutput output;
  if (find_fault(input, dt) || !input.present) {
    ramp_ = 0.0;
  } else {
    output = let_through(input, dt);
  }
  last_force_ = output.force;
  last_torque_ = output.torque;
  return output;
}

// the share of the force: none unless armed, and all of it a while after that
double ForceGuard::ramp(const GuardInput& input, double dt, std::uint32_t& limits) noexcept {
  if (input.clutched) {
    ramp_ = 0.0;
    limits |= kLimitClutch;
    return 0.0;
  }
  if (!armed_) return 0.0;
  ramp_ = limits_.arm_ramp > 0.0 ? std::min(1.0, ramp_ + dt / limits_.arm_ramp) : 1.0;
  if (ramp_ < 1.0) limits |= kLimitRamp;
  return ramp_;
}

GuardOutput ForceGuard::let_through(const GuardInput& input, double dt) noexcept {
  GuardOutput output;
  const double share = ramp(input, dt, output.limits);

  // magnitude
  const double bound = mean_force_.bound(limits_.max_force);
  double scale = 1.0;
  const glm::dvec3 wanted = clamp_length(share * input.force, bound, scale);
  if (scale < 1.0) output.limits |= bound < limits_.max_force ? kLimitMeanForce : kLimitForce;
  const glm::dvec3 wanted_torque = share * scale * input.torque;

  // slew: of two forces within the limit every force between them is too
  const glm::dvec3 change = clamp_length(wanted - last_force_, limits_.max_force_rate * dt, scale);
  if (scale < 1.0) output.limits |= kLimitRate;
  output.force = scale < 1.0 ? last_force_ + change : wanted;
  output.torque = last_torque_ + scale * (wanted_torque - last_torque_);
  return output;
}

}  // namespace haptic::safety
