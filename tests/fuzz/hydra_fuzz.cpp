// Reports of a Razer Hydra: a wand that is told has a place and a rotation.

#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "drivers/hydra/hydra_protocol.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace haptic::drivers;
  for (const std::size_t number : {0U, 1U, 2U}) {
    const auto wand = hydra::decode({data, size}, number);
    if (!wand) continue;
    if (number > 1 || size != hydra::kReportBytes) std::abort();
    if (!(std::abs(glm::length(wand->orientation) - 1.0) < 1e-9)) std::abort();
    for (int axis = 0; axis < 3; ++axis) {
      if (!(std::abs(wand->position[axis]) <= 32.768)) std::abort();
    }
  }
  return 0;
}
