// Bytes from a Falcon, cut anywhere: whatever they say, no packet asks for more than the motors' range, none
// pushes unless the position is trusted, and what is told is finite. The first byte of each piece is its
// length.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "drivers/falcon/falcon_control.h"
#include "drivers/falcon/ftdi.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace haptic::drivers;
  std::span<const std::uint8_t> bytes(data, size);
  falcon::FalconControl control({.ramp = 2'000'000});
  Nanoseconds now = 0;
  while (!bytes.empty()) {
    const std::size_t length = std::min<std::size_t>(bytes[0], bytes.size() - 1);
    now += 1'000'000;
    falcon::strip_status(bytes.subspan(1, length),
                         [&](std::span<const std::uint8_t> part) { control.take(part, now); });
    bytes = bytes.subspan(1 + length);

    const falcon::Packet packet = control.next_packet({.expires = now + 1, .force = {3.0, -2.0, 1.0}}, now);
    const bool is_quiet =
        std::all_of(packet.begin() + 1, packet.begin() + 13, [](auto b) { return b == 0x41; });
    if (!is_quiet && (control.hold(now) != falcon::Hold::kNone || !control.sample())) std::abort();
    for (std::size_t i = 1; i < 13; ++i) {
      if (packet[i] < 0x41 || packet[i] > 0x50) std::abort();
    }
    if (!control.sample()) continue;
    const DeviceSample& sample = *control.sample();
    if (!std::isfinite(sample.position.x + sample.position.y + sample.position.z)) std::abort();
    if (!std::isfinite(sample.velocity.x + sample.velocity.y + sample.velocity.z)) std::abort();
  }
  return 0;
}
