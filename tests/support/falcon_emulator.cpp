#include "tests/support/falcon_emulator.h"

#include <algorithm>
#include <cstdlib>
#include <glm/mat3x3.hpp>
#include <utility>

#include "drivers/falcon/falcon_kinematics.h"

namespace haptic::test {

namespace {

constexpr std::uint16_t kBaudHandshake = 0x4138;
constexpr std::uint16_t kBaudUpload = 0x0015;
constexpr std::uint16_t kBaudRun = 0x0002;

int signed_word(std::span<const std::uint8_t> nibbles) {
  int value = 0;
  for (std::size_t i = 0; i < 4; ++i) value += (nibbles[i] - 'A') << (4 * i);
  return value >= 0x8000 ? value - 0x10000 : value;
}

}  // namespace

FalconEmulator::FalconEmulator(std::vector<std::uint8_t> firmware)
    : firmware_(std::move(firmware)), stage_(firmware_.empty() ? Stage::kRunning : Stage::kBootLoader) {}

void FalconEmulator::control(std::uint8_t request, std::uint16_t value) {
  if (request == 0x03) baud_ = value;
  if (request == 0x00 && value == 1) out_.clear();
  if (request != 0x01 || (value & 0x0100U) == 0) return;
  const bool is_high = (value & 1U) != 0;
  if (is_high && !dtr_ && stage_ != Stage::kRunning) {
    was_reset_ = true;
    stage_ = Stage::kBootLoader;
    loaded_.clear();
  }
  dtr_ = is_high;
}

void FalconEmulator::receive(std::span<const std::uint8_t> bytes) {
  for (const std::uint8_t byte : bytes) {
    switch (stage_) {
      case Stage::kBootLoader:
        take_boot_byte(byte);
        break;
      case Stage::kLoadMode:
        take_load_byte(byte);
        break;
      case Stage::kRunning:
        take_packet_byte(byte);
        break;
    }
  }
}

std::vector<std::uint8_t> FalconEmulator::send(std::size_t most) {
  const auto count = static_cast<std::ptrdiff_t>(std::min(most, out_.size()));
  std::vector<std::uint8_t> bytes(out_.begin(), out_.begin() + count);
  out_.erase(out_.begin(), out_.begin() + count);
  return bytes;
}

void FalconEmulator::take_boot_byte(std::uint8_t byte) {
  if (!was_reset_) return;
  if (baud_ == kBaudUpload && !dtr_ && byte == 0x41) {
    out_.push_back(byte);
    stage_ = Stage::kLoadMode;
    return;
  }
  if (baud_ != kBaudHandshake) return;
  constexpr std::array<std::uint8_t, 3> kHello = {0x0A, 0x43, 0x0D};
  hello_ = byte == kHello[hello_] ? hello_ + 1 : 0;
  if (hello_ < kHello.size()) return;
  hello_ = 0;
  if (troubles.deaf_hellos > 0) {
    --troubles.deaf_hellos;
    return;
  }
  if (troubles.leading_zero) out_.push_back(0);
  out_.insert(out_.end(), {0x0A, 0x44, 0x2C, 0x0D});
}

void FalconEmulator::take_load_byte(std::uint8_t byte) {
  loaded_.push_back(byte);
  const bool is_changed = troubles.changed_echoes > 0 && loaded_.size() == firmware_.size() / 2;
  if (is_changed) --troubles.changed_echoes;
  out_.push_back(is_changed ? static_cast<std::uint8_t>(byte ^ 0x10U) : byte);
  if (loaded_.size() == firmware_.size() && loaded_ == firmware_) stage_ = Stage::kRunning;
}

void FalconEmulator::take_packet_byte(std::uint8_t byte) {
  if (baud_ != kBaudRun) return;
  if (packet_.empty() && byte != '<') {
    ++broken_;
    return;
  }
  packet_.push_back(byte);
  if (packet_.size() < 16) return;
  if (byte == '>') {
    obey();
  } else {
    broken_ += packet_.size();
  }
  packet_.clear();
}

void FalconEmulator::obey() {
  ++packets_;
  for (std::size_t motor = 0; motor < 3; ++motor) {
    motors_[motor] = signed_word(std::span(packet_).subspan(1 + 4 * motor, 4));
  }
  flags_ = static_cast<unsigned>(packet_[13] - 'A');
  if ((flags_ & 1U) == 0 && !troubles.keeps_marks) homed_ = 0;
  if (!troubles.silent) answer();
}

void FalconEmulator::answer() {
  // what cannot be a reply: the start of one that breaks off, and noise
  for (std::size_t i = 0; i < troubles.garbage; ++i) {
    out_.push_back(i % 5 == 0 ? '<' : static_cast<std::uint8_t>(0x41 + i));
  }
  out_.push_back('<');
  for (const int count : counts_) {
    const unsigned value = static_cast<unsigned>(count) & 0xFFFFU;
    for (unsigned nibble = 0; nibble < 4; ++nibble) {
      out_.push_back(static_cast<std::uint8_t>('A' + ((value >> (4 * nibble)) & 15U)));
    }
  }
  out_.push_back(static_cast<std::uint8_t>('A' + (buttons_ | homed_ << 4U)));
  out_.push_back('A');
  out_.push_back('>');
}

void FalconEmulator::hold_at(const glm::dvec3& position) {
  const auto thighs = drivers::falcon::inverse_kinematics(position);
  if (!thighs) std::abort();
  const auto counts = drivers::falcon::counts_of(*thighs);
  counts_ = {counts[0], counts[1], counts[2]};
}

glm::dvec3 FalconEmulator::force() const {
  using namespace drivers::falcon;
  const Words counts = {static_cast<std::int16_t>(counts_[0]), static_cast<std::int16_t>(counts_[1]),
                        static_cast<std::int16_t>(counts_[2])};
  const auto position = forward_kinematics(thigh_angles(counts), kCentre);
  if (!position) std::abort();
  // F . dP = tau . dtheta for every dP
  constexpr double kStep = 1e-6;
  glm::dvec3 force(0.0);
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec3 step(0.0);
    step[axis] = kStep;
    const glm::dvec3 turn = *inverse_kinematics(*position + step) - *inverse_kinematics(*position - step);
    for (int leg = 0; leg < 3; ++leg) {
      const double torque = -motors_[static_cast<std::size_t>(leg)] / 10000.0;
      force[axis] += torque * turn[leg] / (2.0 * kStep);
    }
  }
  return force;
}

}  // namespace haptic::test
