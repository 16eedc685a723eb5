// Bytes from a FASTRAK: each record that is found is one in all that is known of it.

#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "drivers/fastrak/fastrak_protocol.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace haptic::drivers;
  fastrak::RecordParser parser;
  fastrak::Record record;
  for (std::size_t i = 0; i < size; ++i) {
    if (!parser.take(data[i], record)) continue;
    if (record.station < 1 || record.station > 4) std::abort();
    if (!(std::abs(glm::length(record.orientation) - 1.0) < 1e-9)) std::abort();
    for (int axis = 0; axis < 3; ++axis) {
      if (!(std::abs(record.position[axis]) <= 10.0)) std::abort();
    }
  }
  return 0;
}
