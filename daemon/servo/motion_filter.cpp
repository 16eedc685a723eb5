#include "servo/motion_filter.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace haptic::servo {

namespace {

constexpr double kPi = 3.14159265358979323846;

double seconds(drivers::Nanoseconds time) noexcept { return static_cast<double>(time) * 1e-9; }

bool is_finite(const glm::dvec3& v) noexcept {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

}  // namespace

MotionFilter::MotionFilter(const MotionFilterSettings& settings, double rate_hz) : settings_(settings) {
  if (settings.kind == MotionFilterKind::kDriver) return;
  // the newest, those in the window, and one before it
  const bool looks_back = settings.kind == MotionFilterKind::kAdaptiveWindow;
  ring_.resize(2 + (looks_back ? static_cast<std::size_t>(std::ceil(settings.window * rate_hz)) : 0));
}

const Motion& MotionFilter::take(const drivers::DeviceSample& sample) noexcept {
  if (settings_.kind == MotionFilterKind::kDriver) {
    motion_.velocity = sample.velocity;
    return motion_;
  }
  if (!is_finite(sample.position)) {
    forget();
    return motion_;
  }
  if (count_ > 0) {
    const drivers::Nanoseconds passed = sample.time - at(0).time;
    if (passed == 0) return motion_;
    if (passed < 0 || seconds(passed) > kMotionGap) forget();
  }
  push(sample);
  if (settings_.kind == MotionFilterKind::kLowPass) {
    smooth();
  } else {
    fit_window();
    fit_acceleration();
  }
  return motion_;
}

MotionFilter::Moment& MotionFilter::at(std::size_t back) noexcept {
  return ring_[(newest_ + ring_.size() - back) % ring_.size()];
}

void MotionFilter::push(const drivers::DeviceSample& sample) noexcept {
  newest_ = (newest_ + 1) % ring_.size();
  count_ = std::min(count_ + 1, ring_.size());
  at(0) = {.time = sample.time, .position = sample.position};
}

void MotionFilter::forget() noexcept {
  count_ = 0;
  motion_ = {};
}

// Where all positions are within the noise of some line, those between the ends are within twice the noise of
// the line through the ends, which are off as well. That is so if its slope lies in an interval for each of
// them: these are cut with each other on the way back, and each sample is looked at once.
void MotionFilter::fit_window() noexcept {
  constexpr double kAny = std::numeric_limits<double>::infinity();
  for (glm::length_t axis = 0; axis < 3; ++axis) {
    double lowest = -kAny;
    double highest = kAny;
    double slope = 0.0;
    for (std::size_t back = 1; back < count_; ++back) {
      const double span = seconds(at(0).time - at(back).time);
      if (span > settings_.window && lowest > -kAny) break;
      if (span < kShortestSpan) continue;
      const double candidate = (at(0).position[axis] - at(back).position[axis]) / span;
      if (candidate < lowest || candidate > highest) break;
      slope = candidate;
      lowest = std::max(lowest, candidate - 2.0 * settings_.noise / span);
      highest = std::min(highest, candidate + 2.0 * settings_.noise / span);
    }
    motion_.velocity[axis] = slope;
  }
  at(0).velocity = motion_.velocity;
}

// the slope of the straight line through the velocities with the least squares of errors
void MotionFilter::fit_acceleration() noexcept {
  std::size_t used = 1;
  double time = 0.0;  // mean, back from the newest
  while (used < count_ && seconds(at(0).time - at(used).time) <= settings_.window) {
    time += seconds(at(0).time - at(used).time);
    ++used;
  }
  motion_.acceleration = glm::dvec3(0.0);
  if (used < 3) return;
  time /= static_cast<double>(used);
  glm::dvec3 covariance(0.0);
  double variance = 0.0;
  for (std::size_t back = 0; back < used; ++back) {
    const double before = time - seconds(at(0).time - at(back).time);
    covariance += before * at(back).velocity;
    variance += before * before;
  }
  motion_.acceleration = covariance / variance;
}

// backward Euler: stable for every cut-off
void MotionFilter::smooth() noexcept {
  if (count_ < 2) return;
  const double passed = seconds(at(0).time - at(1).time);
  const double share = passed / (passed + 1.0 / (2.0 * kPi * settings_.cutoff));
  const glm::dvec3 before = motion_.velocity;
  motion_.velocity += share * ((at(0).position - at(1).position) / passed - before);
  motion_.acceleration += share * ((motion_.velocity - before) / passed - motion_.acceleration);
}

}  // namespace haptic::servo
