// Bytes from a Polhemus tracker, read as those of each model: each record that is found is one in all that is
// known of it.

#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "drivers/fastrak/fastrak_protocol.h"

namespace {

using namespace haptic::drivers;

void read(fastrak::Model model, const std::uint8_t* data, std::size_t size) {
  fastrak::RecordParser parser(model);
  fastrak::Record record;
  for (std::size_t i = 0; i < size; ++i) {
    if (!parser.take(data[i], record)) continue;
    if (record.station < 1 || record.station > fastrak::stations_of(model)) std::abort();
    if (!(std::abs(glm::length(record.orientation) - 1.0) < 1e-9)) std::abort();
    for (int axis = 0; axis < 3; ++axis) {
      if (!(std::abs(record.position[axis]) <= 10.0)) std::abort();
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  for (const auto model : {fastrak::Model::kFastrak, fastrak::Model::kLiberty, fastrak::Model::kPatriot}) {
    read(model, data, size);
  }
  return 0;
}
