#include "drivers/simulated/simulated_device.h"

#include <limits>
#include <utility>

namespace haptic::drivers {

namespace {

// the error of a step grows with its length: at 0.1 ms a hand of 300 N/m with 0.1 kg is damped by 0.3 % of
// the critical damping too much
constexpr Nanoseconds kLongestStep = 100'000;

// bounds the work of one read() to 1000 steps; what happened before has died away in any hand worth the name
constexpr Nanoseconds kLongestGap = 100'000'000;

double seconds(Nanoseconds nanoseconds) noexcept { return static_cast<double>(nanoseconds) * 1e-9; }

}  // namespace

SimulatedDevice::SimulatedDevice(SimulatedSettings settings)
    : info_{.name = settings.name,
            .driver = "simulated",
            .max_force = std::numeric_limits<double>::infinity()},
      settings_(std::move(settings)),
      faults_(settings_.faults) {}

void SimulatedDevice::start() {
  running_ = true;
  timed_ = false;
  position_ = sample(settings_.path, 0.0, settings_.repeat).position;
  velocity_ = glm::dvec3(0.0);
  command_ = {};
  faults_.start();
}

void SimulatedDevice::stop() noexcept { running_ = false; }

bool SimulatedDevice::read(Nanoseconds now, DeviceSample& device_sample) noexcept {
  if (!running_) return false;
  if (!timed_) {
    start_time_ = now;
    time_ = now;
    timed_ = true;
  }
  advance(now);
  const PathSample hand = sample(settings_.path, seconds(now - start_time_), settings_.repeat);
  DeviceSample measured{.time = now,
                        .position = position_,
                        .orientation = hand.orientation,
                        .velocity = velocity_,
                        .buttons = 0};
  if (!faults_.pass(now - start_time_, measured)) return false;
  device_sample = measured;
  return true;
}

void SimulatedDevice::write(Nanoseconds /*now*/, const ForceCommand& command) noexcept {
  command_ = faults_.is_unplugged() ? ForceCommand{} : command;
}

void SimulatedDevice::advance(Nanoseconds to) noexcept {
  if (to - time_ > kLongestGap) time_ = to - kLongestGap;
  const Nanoseconds gap = to - time_;
  if (gap <= 0) return;
  const Nanoseconds steps = (gap + kLongestStep - 1) / kLongestStep;
  for (Nanoseconds i = 0; i < steps; ++i) {
    const Nanoseconds from = time_ + gap * i / steps;
    step(from, seconds(time_ + gap * (i + 1) / steps - from));
  }
  time_ = to;
}

void SimulatedDevice::step(Nanoseconds from, double dt) noexcept {
  const glm::dvec3 force = from < command_.expires ? command_.force : glm::dvec3(0.0);
  const PathSample hand = sample(settings_.path, seconds(from - start_time_) + dt, settings_.repeat);

  // backward Euler: stable for every mass, stiffness and damping
  const double k = settings_.hand_stiffness;
  const double b = settings_.hand_damping;
  const double m = settings_.mass;
  const glm::dvec3 impulse = dt * (force + k * (hand.position - position_) + b * hand.velocity);
  velocity_ = (m * velocity_ + impulse) / (m + dt * (b + settings_.damping) + dt * dt * k);
  position_ += dt * velocity_;
}

}  // namespace haptic::drivers
