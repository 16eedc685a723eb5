#pragma once
// How warm a device's motors are, as far as forces tell: the running mean of their magnitude, in which the
// past fades with a time constant.
//
//   d mean / dt = (|F| - mean) / time
//
//   bound on |F|   ------+
//    max_force           |\                    From 90 % of the limit on the bound comes down in a straight
//                        | \                   line, slowly, as the mean does not jump; it meets the limit
//    limit               |  +-------           where the mean does. So the mean never goes beyond the limit,
//                       90 % limit    mean     and a force within the limit is never scaled down.

#include <algorithm>

namespace haptic::safety {

/// Real-time safe.
class MeanForce {
 public:
  /// The limit in N, infinite for none; the time in s, > 0.
  MeanForce(double limit, double time) noexcept : limit_(limit), time_(time) {}

  /// `force` (N, magnitude) was given for `dt` seconds.
  void take(double force, double dt) noexcept { mean_ += (force - mean_) * dt / (time_ + dt); }

  /// N.
  double mean() const noexcept { return mean_; }

  /// What the magnitude of a force may be now (N), where `max_force` is the most that it may ever be.
  double bound(double max_force) const noexcept {
    const double cool = (limit_ - mean_) / (kBand * limit_);
    // an infinite limit is above every force
    if (max_force <= limit_ || cool >= 1.0) return max_force;
    return limit_ + std::max(0.0, cool) * (max_force - limit_);
  }

 private:
  static constexpr double kBand = 0.1;  // of the limit, in which the bound comes down

  double limit_;
  double time_;
  double mean_ = 0.0;
};

}  // namespace haptic::safety
