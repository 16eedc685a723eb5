#include "drivers/falcon/falcon_control.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>

namespace haptic::drivers::falcon {

namespace {

constexpr Nanoseconds kMillisecond = 1'000'000;

// how long the LED stays green after the last force
constexpr Nanoseconds kGreenAfterForce = 1'000 * kMillisecond;
constexpr Nanoseconds kBlink = 200 * kMillisecond;

// the box within which the kinematics are trusted, m
constexpr glm::dvec3 kBoxLow{-0.06, -0.06, 0.07};
constexpr glm::dvec3 kBoxHigh{0.06, 0.06, 0.18};

bool is_in_box(const glm::dvec3& p) noexcept {
  return p.x >= kBoxLow.x && p.x <= kBoxHigh.x && p.y >= kBoxLow.y && p.y <= kBoxHigh.y && p.z >= kBoxLow.z &&
         p.z <= kBoxHigh.z;
}

bool is_jump(const Words& from, const Words& to, Nanoseconds elapsed) noexcept {
  const Nanoseconds milliseconds = std::max<Nanoseconds>(1, (elapsed + kMillisecond - 1) / kMillisecond);
  for (std::size_t leg = 0; leg < 3; ++leg) {
    const Nanoseconds change = std::abs(Nanoseconds{to[leg]} - Nanoseconds{from[leg]});
    if (change > kMostCountsPerMillisecond * milliseconds) return true;
  }
  return false;
}

}  // namespace

void FalconControl::take(std::span<const std::uint8_t> bytes, Nanoseconds now) noexcept {
  Reply reply;
  for (const std::uint8_t byte : bytes) {
    if (parser_.take(byte, reply)) take(reply, now);
  }
}

void FalconControl::take(const Reply& reply, Nanoseconds now) noexcept {
  const Nanoseconds elapsed = now - last_reply_;
  ++replies_;
  last_reply_ = now;
  if (!is_homed(reply, now)) {
    counted_ = false;
    return distrust(Hold::kNotHomed);
  }
  const bool has_jumped = counted_ && is_jump(counts_, reply.counts, elapsed);
  counts_ = reply.counts;
  counted_ = true;
  if (has_jumped) return distrust(Hold::kJump);

  const glm::dvec3 thighs = thigh_angles(counts_);
  std::optional<glm::dvec3> position = forward_kinematics(thighs, position_);
  if (!position) position = forward_kinematics(thighs, kCentre);
  if (!position) return distrust(Hold::kUnsolvable);
  position_ = *position;
  if (good_replies_ < kSettlingReplies) {
    ++good_replies_;
    return;
  }
  hold_ = is_in_box(position_) ? Hold::kNone : Hold::kOutside;
  sample_ = DeviceSample{.time = now,
                         .position = position_,
                         .velocity = velocity_.take(now, position_),
                         .buttons = reply.buttons};
}

void FalconControl::home(Nanoseconds now) noexcept {
  homes_again_ = true;
  homing_asked_ = now;
  counted_ = false;
  distrust(Hold::kNotHomed);
}

bool FalconControl::is_homed(const Reply& reply, Nanoseconds now) noexcept {
  const bool has_marks = reply.homed == kAllHomed;
  if (!has_marks || now - homing_asked_ >= kMarksWait) homes_again_ = false;
  return has_marks && !homes_again_;
}

void FalconControl::distrust(Hold hold) noexcept {
  hold_ = hold;
  good_replies_ = 0;
  velocity_.reset();
  sample_.reset();
}

Hold FalconControl::hold(Nanoseconds now) const noexcept {
  if (replies_ == 0 || now - last_reply_ >= settings_.reply_age) return Hold::kNoReply;
  return hold_;
}

Packet FalconControl::next_packet(const ForceCommand& wanted, Nanoseconds now) noexcept {
  const Nanoseconds elapsed = std::clamp<Nanoseconds>(now - last_packet_, 0, kMillisecond);
  last_packet_ = now;
  // an expired command has expiry 0: force comes back gently after it too
  const bool may_push = hold(now) == Hold::kNone && now < wanted.expires;
  const double step = static_cast<double>(elapsed) / static_cast<double>(settings_.ramp);
  share_ = may_push ? std::min(1.0, share_ + step) : 0.0;

  const double magnitude = glm::length(wanted.force);
  const bool forgets_marks = homes_again_ && now - homing_asked_ < kNoHoming;
  Request request{.homing = !forgets_marks, .led = led(magnitude > 0.0, now)};
  if (share_ > 0.0 && std::isfinite(magnitude) && magnitude > 0.0) {
    const double scale = share_ * std::min(1.0, settings_.max_force / magnitude);
    const std::optional<glm::dvec3> torques = joint_torques(position_, scale * wanted.force);
    if (torques) request.motors = motor_words(*torques, settings_.gain);
  }
  return encode(request);
}

Led FalconControl::led(bool wants_force, Nanoseconds now) noexcept {
  if (wants_force) {
    force_seen_ = now;
    force_was_seen_ = true;
  }
  if (now < identified_until_) return now / kBlink % 2 == 0 ? Led::kGreen : Led::kRed;
  if (!counted_) return Led::kRed;
  return force_was_seen_ && now - force_seen_ < kGreenAfterForce ? Led::kGreen : Led::kBlue;
}

}  // namespace haptic::drivers::falcon
