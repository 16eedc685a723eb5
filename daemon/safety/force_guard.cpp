#include "safety/force_guard.h"

#include <algorithm>
#include <cmath>

namespace haptic::safety {

namespace {

bool is_finite(const glm::dvec3& v) noexcept {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool is_finite(const glm::dquat& q) noexcept {
  return std::isfinite(q.w) && std::isfinite(q.x) && std::isfinite(q.y) && std::isfinite(q.z);
}

double largest_component(const glm::dvec3& v) noexcept {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

/// Length without overflow on the way; infinite only if the length itself is beyond a double.
double length(const glm::dvec3& v) noexcept {
  const double largest = largest_component(v);
  if (largest == 0.0) return 0.0;
  const glm::dvec3 scaled = v / largest;
  return largest * std::sqrt(scaled.x * scaled.x + scaled.y * scaled.y + scaled.z * scaled.z);
}

/// `v` brought down to `limit` in its own direction if it is longer; `scale` is what it was multiplied by.
glm::dvec3 clamp_length(const glm::dvec3& v, double limit, double& scale) noexcept {
  scale = 1.0;
  if (length(v) <= limit) return v;
  const double largest = largest_component(v);
  const glm::dvec3 scaled = v / largest;
  const double unit = limit / length(scaled);
  scale = unit / largest;
  return scaled * unit;
}

}  // namespace

bool ForceGuard::arm() noexcept {
  if (fault_.kind != FaultKind::kNone) return false;
  if (!armed_) ramp_ = 0.0;
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

bool ForceGuard::find_fault(const GuardInput& input) noexcept {
  const bool finite = is_finite(input.position) && is_finite(input.orientation) &&
                      is_finite(input.velocity) && is_finite(input.force) && is_finite(input.torque) &&
                      !std::isnan(input.sample_age);
  if (!finite) {
    latch_measured(FaultKind::kNotFinite, input, 0.0, 0.0);
  } else if (armed_ && input.present && length(input.velocity) > limits_.max_speed) {
    latch_measured(FaultKind::kOverSpeed, input, length(input.velocity), limits_.max_speed);
  } else if (armed_ && input.present && input.sample_age > limits_.max_sample_age) {
    latch_measured(FaultKind::kStaleSample, input, input.sample_age, limits_.max_sample_age);
  }
  return cut_;
}

GuardOutput ForceGuard::guard(const GuardInput& input, double dt) noexcept {
  if (find_fault(input) || !input.present) {
    ramp_ = 0.0;
    last_force_ = last_torque_ = glm::dvec3(0.0);
    return {};
  }
  GuardOutput output;

  // ramp after arming, or no force at all
  double ramp = 0.0;
  if (armed_) {
    ramp_ = limits_.arm_ramp > 0.0 ? std::min(1.0, ramp_ + dt / limits_.arm_ramp) : 1.0;
    ramp = ramp_;
    if (ramp < 1.0) output.limits |= kLimitRamp;
  }

  // magnitude
  double scale = 1.0;
  const glm::dvec3 wanted = clamp_length(ramp * input.force, limits_.max_force, scale);
  if (scale < 1.0) output.limits |= kLimitForce;
  const glm::dvec3 wanted_torque = ramp * scale * input.torque;

  // slew: of two forces within the limit every force between them is too
  const glm::dvec3 change = clamp_length(wanted - last_force_, limits_.max_force_rate * dt, scale);
  if (scale < 1.0) output.limits |= kLimitRate;
  output.force = scale < 1.0 ? last_force_ + change : wanted;
  output.torque = last_torque_ + scale * (wanted_torque - last_torque_);

  last_force_ = output.force;
  last_torque_ = output.torque;
  return output;
}

}  // namespace haptic::safety
