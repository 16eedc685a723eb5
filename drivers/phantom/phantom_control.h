#pragma once
// What a PHANToM's driver decides, without any I/O: registers and a force in, a sample and the next outputs
// out, on a clock that is passed in.
//
// There is a position once it is known what the counts mean (Reference), and no force before. Force is let
// through only while all of this holds, and is ramped in afterwards:
//   - registers were read less than `reading_age` ago;
//   - no angle changes faster than a hand can move an arm;
//   - all angles are within what the calibration believes.
// A button that defines the rest pose must have been seen released first. One that was calibrated may be
// pressed like any other.
//
// Real-time safe. For the driver's thread alone.

#include <array>
#include <cstdint>
#include <optional>

#include "drivers/device.h"
#include "drivers/phantom/phantom_kinematics.h"
#include "drivers/phantom/phantom_protocol.h"
#include "drivers/velocity_estimate.h"

namespace haptic::drivers::phantom {

/// How it is known what the counts mean.
enum class Reference {
  kRestAtStart,   // the first that is read is the rest pose
  kRestAtButton,  // that at which the button is pressed for the first time
  kCountsAreKept  // rest_counts are those of the rest pose
};

/// One device's own constants; see PhantomCalibration in haptic/v1/calibration.proto.
struct Calibration {
  Geometry geometry{};
  RegisterMap map{};
  std::array<double, 3> counts_per_radian{};
  std::array<std::int32_t, 3> rest_counts{};
  glm::dvec3 rest_angles{0.0};   // rad
  glm::dvec3 least_angles{0.0};  // rad, that are believed
  glm::dvec3 greatest_angles{0.0};
  glm::dvec3 words_per_torque{0.0};  // 1/(N m)
  Reference reference = Reference::kRestAtButton;
};

struct ControlSettings {
  Calibration calibration{};
  double max_force = 0.0;                // N, magnitude; 0: none ever
  Nanoseconds reading_age = 10'000'000;  // beyond which force is held back
  Nanoseconds ramp = 50'000'000;         // from none to all of the force, after it was held back
};

/// Why force is held back.
enum class Hold {
  kNone,
  kNoReading,    // none yet, or it is too old
  kNoReference,  // it is not known what the counts mean
  kJump,         // an angle changed faster than it can; until kSettlingReadings good ones came
  kOutside,      // an angle is beyond those that are believed
};

/// Good readings in a row before counts are trusted again.
inline constexpr int kSettlingReadings = 50;
/// The fastest change of an angle that is believed, rad/s: 2 m/s of the finger at 8 cm from the base's axis.
inline constexpr double kFastest = 25.0;

class PhantomControl {
 public:
  explicit PhantomControl(const ControlSettings& settings) noexcept : settings_(settings) {}

  /// The input registers as they were read at `now`.
  void take(const Registers& inputs, Nanoseconds now) noexcept;

  /// The outputs to write at `now`. `wanted` is alive: zero force if no command is.
  Registers next_outputs(const ForceCommand& wanted, Nanoseconds now) noexcept;

  /// In the device's frame; nothing unless its position is trusted. An arm outside its angles has one.
  const std::optional<DeviceSample>& sample() const noexcept { return sample_; }

  /// Why a force at `now` would be held back.
  Hold hold(Nanoseconds now) const noexcept;

 private:
  bool refer(const Registers& inputs) noexcept;
  bool advance(const Registers& inputs, Nanoseconds elapsed) noexcept;
  bool is_believed() const noexcept;
  std::uint32_t raw(const Registers& inputs, std::size_t joint) const noexcept;

  ControlSettings settings_;
  bool has_reading_ = false;
  bool has_reference_ = false;
  bool was_released_ = false;  // the button, since the start
  Nanoseconds last_reading_ = 0;
  Hold hold_ = Hold::kNoReading;
  int good_readings_ = 0;
  std::array<std::uint32_t, 3> raw_{};
  std::array<std::int64_t, 3> counts_{};  // from the rest pose
  glm::dvec3 angles_{0.0};
  VelocityEstimate velocity_{0.004};
  std::optional<DeviceSample> sample_;

  Nanoseconds last_outputs_ = 0;
  double share_ = 0.0;  // of the force, 0 to 1
};

}  // namespace haptic::drivers::phantom
