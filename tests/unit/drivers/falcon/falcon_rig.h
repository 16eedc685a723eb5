#pragma once
// The driver's decisions against the emulated device on a virtual clock: no thread, no USB.

#include <glm/vec3.hpp>
#include <vector>

#include "drivers/falcon/falcon_control.h"
#include "tests/support/falcon_emulator.h"

namespace haptic::drivers::falcon {

constexpr Nanoseconds kMillisecond = 1'000'000;

class FalconRig {
 public:
  explicit FalconRig(const ControlSettings& settings = {}) : control(settings) {
    emulator.control(0x03, 0x0002);  // 1.5 Mbaud
  }

  /// A homed device at `position` whose counts are trusted, and whose force is ramped in.
  void settle_at(const glm::dvec3& position) {
    emulator.set_homed(kAllHomed);
    emulator.hold_at(position);
    run(kSettlingReplies + 1, {});
    run(60, {1e-9, 0.0, 0.0});
  }

  /// `ticks` of 1 ms with this force wanted (N); each reply comes within its tick.
  void run(int ticks, const glm::dvec3& force) {
    for (int i = 0; i < ticks; ++i) exchange({.expires = now + 3 * kMillisecond, .force = force});
  }

  void exchange(const ForceCommand& wanted) {
    now += kMillisecond;
    const Packet packet = control.next_packet(wanted, now);
    emulator.receive(packet);
    const std::vector<std::uint8_t> bytes = emulator.send(1000);
    control.take(bytes, now + kMillisecond / 2);
  }

  bool motors_rest() const { return emulator.motors() == std::array<int, 3>{}; }

  Nanoseconds now = 0;
  FalconControl control;
  test::FalconEmulator emulator;
};

}  // namespace haptic::drivers::falcon
