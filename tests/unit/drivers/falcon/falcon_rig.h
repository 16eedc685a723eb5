#pragma once
// The driver's decisions against the emulated device on a virtual clock: no thread, no USB.

#include <deque>
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
    on_the_way.push_back(emulator.send(1000));
    if (on_the_way.size() <= delay) return;
    control.take(on_the_way.front(), now + kMillisecond / 2);
    on_the_way.pop_front();
  }

  bool motors_rest() const { return emulator.motors() == std::array<int, 3>{}; }

  std::size_t delay = 0;  // ticks that a reply takes
  std::deque<std::vector<std::uint8_t>> on_the_way;
  Nanoseconds now = 0;
  FalconControl control;
  test::FalconEmulator emulator;
};

}  // namespace haptic::drivers::falcon
