// Reports and datagrams of a WoodenHaptics arm, 14 bytes each: whatever they say, currents stay within their
// limit, there are none without calibration, and the place is finite.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "drivers/polhem/polhem_control.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace haptic::drivers;
  std::span<const std::uint8_t> bytes(data, size);
  (void)polhem::decode_datagram(bytes);
  polhem::PolhemControl control({.rest_counts = {0, 0, 6000}, .max_current = 1.0});
  for (Nanoseconds now = 1; !bytes.empty(); now += 1'000'000) {
    const std::size_t length = std::min(bytes.size(), polhem::kMessageBytes);
    const auto reading = polhem::decode_report(bytes.first(length));
    bytes = bytes.subspan(length);
    if (!reading) continue;
    control.take(*reading, now);
    const polhem::Message answer = control.answer({.expires = now + 1, .force = {5.0, -3.0, 2.0}});
    for (std::size_t joint = 0; joint < 3; ++joint) {
      const auto current = static_cast<std::int16_t>(
          static_cast<std::uint16_t>(answer[2 * joint] | answer[2 * joint + 1] << 8U));
      if (std::abs(current) > 1000) std::abort();
      if (current != 0 && !control.sample()) std::abort();
    }
    if (!control.sample()) continue;
    const DeviceSample& sample = *control.sample();
    if (!std::isfinite(sample.position.x + sample.position.y + sample.position.z)) std::abort();
    if (!std::isfinite(sample.velocity.x + sample.velocity.y + sample.velocity.z)) std::abort();
  }
  return 0;
}
