#include "drivers/external/external_protocol.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "drivers/device_link.h"

namespace haptic::drivers::external {

namespace {

constexpr double kFarthest = 1e6;  // m; as in files: far from overflow
constexpr double kOrientationTolerance = 1e-3;

static_assert(sizeof(haptic_sample) == 112 && offsetof(haptic_sample, buttons) == 104);
static_assert(sizeof(haptic_force) == 80 && offsetof(haptic_force, refusal) == 72);

glm::dvec3 vector(const double (&v)[3]) noexcept { return {v[0], v[1], v[2]}; }

// what is no number is not too far
bool is_too_far(const double (&position)[3]) noexcept {
  return std::any_of(std::begin(position), std::end(position), [](double coordinate) {
    return std::isfinite(coordinate) && std::abs(coordinate) > kFarthest;
  });
}

/// False if it is finite and no rotation.
bool read_orientation(const double (&q)[4], glm::dquat& orientation) noexcept {
  orientation = {q[0], q[1], q[2], q[3]};
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (std::isnan(length)) return true;
  if (std::abs(length - 1.0) > kOrientationTolerance) return false;
  orientation /= length;
  return true;
}

haptic_force write(haptic_message_kind kind) noexcept {
  haptic_force message{};
  message.magic = HAPTIC_DEVICE_MAGIC;
  message.version = HAPTIC_DEVICE_VERSION;
  message.kind = static_cast<std::uint16_t>(kind);
  return message;
}

void write(double (&out)[3], const glm::dvec3& v) noexcept {
  out[0] = v.x;
  out[1] = v.y;
  out[2] = v.z;
}

}  // namespace

std::variant<DeviceSample, haptic_refusal> read_sample(std::span<const std::byte> message, Nanoseconds now,
                                                       Conversation& conversation) noexcept {
  // magic and version come first in every version, whatever its size
  constexpr std::size_t kHead = offsetof(haptic_sample, kind);
  haptic_sample told{};
  if (message.size() < kHead) return HAPTIC_MALFORMED;
  std::memcpy(&told, message.data(), std::min(message.size(), sizeof(told)));
  if (told.magic != HAPTIC_DEVICE_MAGIC) return HAPTIC_MALFORMED;
  if (told.version != HAPTIC_DEVICE_VERSION) return HAPTIC_OTHER_VERSION;
  if (message.size() != sizeof(told) || told.kind != HAPTIC_SAMPLE || told.reserved != 0) {
    return HAPTIC_MALFORMED;
  }
  // a sample from the future would never grow old
  const bool is_in_order = told.sequence > conversation.last_sequence &&
                           told.time_ns >= conversation.last_time && told.time_ns <= now;
  if (!is_in_order) return HAPTIC_MALFORMED;

  DeviceSample sample{.time = told.time_ns,
                      .position = vector(told.position),
                      .velocity = vector(told.velocity),
                      .buttons = told.buttons};
  if (is_too_far(told.position) || !read_orientation(told.orientation, sample.orientation)) {
    return HAPTIC_MALFORMED;
  }
  conversation = {.last_sequence = told.sequence, .last_time = told.time_ns};
  return sample;
}

haptic_force write_force(const ForceCommand& live, std::uint64_t sequence, Nanoseconds now) noexcept {
  haptic_force message = write(HAPTIC_FORCE);
  message.sequence = sequence;
  message.expires_ns = std::min(live.expires, now + kForceLifetime);
  write(message.force, live.force);
  write(message.torque, live.torque);
  return message;
}

haptic_force write_refusal(haptic_refusal refusal) noexcept {
  haptic_force message = write(HAPTIC_REFUSED);
  message.refusal = refusal;
  return message;
}

const char* in_words(haptic_refusal refusal) noexcept {
  switch (refusal) {
    case HAPTIC_MALFORMED:
      return "its message is malformed";
    case HAPTIC_OTHER_VERSION:
      return "it speaks another version";
    case HAPTIC_BUSY:
      return "another program serves this device";
    case HAPTIC_NOT_PERMITTED:
      return "its user may not serve this device";
    case HAPTIC_SILENT:
      return "it fell silent";
    case HAPTIC_STOPPED:
      return "the daemon stops";
    default:
      return "";
  }
}

}  // namespace haptic::drivers::external
