#pragma once
// What a Falcon's driver decides, without any I/O: bytes and a force in, a sample and the next packet out, on
// a clock that is passed in.
//
// It lets force through only while all of this holds, and ramps it in afterwards:
//   - all three encoders have passed their marks: before, counts start anywhere, and jump when they do;
//     again after home(), which asks for no homing for a while: whether the firmware forgets its marks then
//     is not known, so one that still keeps them after kMarksWait is trusted with them again;
//   - the last reply is younger than `reply_age`;
//   - counts change no faster than a hand can move the grip;
//   - the kinematics converge, and the grip is within the box in which they are trusted.
// Every other packet asks for homing. LEDs: red without homing, blue when homed, green while force is wanted,
// green and red in turn while it shows which one it is.
//
// Real-time safe. For the driver's thread alone.

#include <cstdint>
#include <optional>
#include <span>

#include "drivers/device.h"
#include "drivers/falcon/falcon_kinematics.h"
#include "drivers/falcon/falcon_protocol.h"
#include "drivers/velocity_estimate.h"

namespace haptic::drivers::falcon {

struct ControlSettings {
  double gain = 10000.0;              // motor words per N m; not calibrated
  double max_force = 4.0;             // N, magnitude
  Nanoseconds reply_age = 5'000'000;  // beyond which force is held back
  Nanoseconds ramp = 50'000'000;      // from none to all of the force, after it was held back
};

/// Why force is held back.
enum class Hold {
  kNone,
  kNoReply,  // none yet, or it is too old
  kNotHomed,
  kJump,        // counts changed faster than a hand can; until kSettlingReplies good ones came
  kUnsolvable,  // no position belongs to the angles; the same
  kOutside,     // beyond the trusted box
};

/// Good replies in a row before counts are trusted again.
inline constexpr int kSettlingReplies = 50;
/// The fastest change of a count that is believed, per millisecond: about 2 m/s.
inline constexpr int kMostCountsPerMillisecond = 60;
/// How long home() asks for no homing, and how long the firmware may take to forget its marks.
inline constexpr Nanoseconds kNoHoming = 200'000'000;
inline constexpr Nanoseconds kMarksWait = 1'000'000'000;
/// How long identify() lasts.
inline constexpr Nanoseconds kIdentifying = 3'000'000'000;

class FalconControl {
 public:
  explicit FalconControl(const ControlSettings& settings) noexcept : settings_(settings) {}

  /// Bytes from the device, without the bridge's status, as they came at `now`.
  void take(std::span<const std::uint8_t> bytes, Nanoseconds now) noexcept;

  /// The packet to send at `now`. `wanted` is alive: zero force if no command is.
  Packet next_packet(const ForceCommand& wanted, Nanoseconds now) noexcept;

  /// Shows which one it is, from `now` on.
  void identify(Nanoseconds now) noexcept { identified_until_ = now + kIdentifying; }

  /// Its position does not count until it has been homed again.
  void home(Nanoseconds now) noexcept;

  /// What the last reply told, in the device's frame; nothing unless its position is trusted. A grip outside
  /// the box has one.
  const std::optional<DeviceSample>& sample() const noexcept { return sample_; }

  /// Why a force at `now` would be held back.
  Hold hold(Nanoseconds now) const noexcept;

  std::uint64_t replies() const noexcept { return replies_; }
  std::uint64_t skipped_bytes() const noexcept { return parser_.skipped(); }

 private:
  void take(const Reply& reply, Nanoseconds now) noexcept;
  void distrust(Hold hold) noexcept;
  bool is_homed(const Reply& reply, Nanoseconds now) noexcept;
  Led led(bool wants_force, Nanoseconds now) noexcept;

  ControlSettings settings_;
  ReplyParser parser_;
  std::uint64_t replies_ = 0;
  Nanoseconds last_reply_ = 0;
  Hold hold_ = Hold::kNoReply;
  Words counts_{};
  bool counted_ = false;  // counts_ are of homed encoders
  int good_replies_ = 0;
  glm::dvec3 position_ = kCentre;  // the last that was solved
  VelocityEstimate velocity_{0.004};
  std::optional<DeviceSample> sample_;

  Nanoseconds last_packet_ = 0;
  double share_ = 0.0;  // of the force, 0 to 1
  Nanoseconds identified_until_ = 0;
  bool homes_again_ = false;  // its marks do not count until it has forgotten them
  Nanoseconds homing_asked_ = 0;
  Nanoseconds force_seen_ = 0;
  bool force_was_seen_ = false;
};

}  // namespace haptic::drivers::falcon
